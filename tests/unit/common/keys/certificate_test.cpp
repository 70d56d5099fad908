// SPDX-License-Identifier: Apache-2.0
#include "common/keys/certificate.hpp"

#include "common/file/write_file.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/test_keys.hpp"

namespace sidestep::certificate_test {

using std::chrono::hours;

struct Fixture {
  Time now = time_from_ns(1'800'000'000'000'000'000);
  Authority authority{"identity authority", now, now + hours(24)};
  Certificate certificate = authority.issue({Role::kAgent, 3, 3}, make_private_key(), now, now + hours(1));
};

TEST_CASE("a certificate states its owner, issuer and validity period") {
  const Fixture f;
  const Authority other("identity authority", f.now, f.now + hours(24));
  CHECK(f.certificate.identity() == Identity{Role::kAgent, 3, 3});
  CHECK(f.certificate.subject() == "CN=agent 3,O=Sidestep");
  CHECK(f.certificate.not_before() == f.now);
  CHECK(f.certificate.not_after() == f.now + hours(1));
  CHECK(f.certificate.is_issued_by(f.authority.certificate()));
  CHECK_FALSE(f.certificate.is_issued_by(other.certificate()));
  CHECK_FALSE(f.authority.certificate().identity());
}

TEST_CASE("a certificate survives DER encoding, and bytes that are not a certificate are rejected") {
  const Fixture f;
  const std::vector<std::uint8_t> der = f.certificate.der();
  REQUIRE(Certificate::from_der(der));
  CHECK(Certificate::from_der(der)->serial() == f.certificate.serial());
  for (std::size_t size = 0; size < der.size(); ++size)
    CHECK_FALSE(Certificate::from_der(std::span(der).first(size)));
  std::vector<std::uint8_t> longer = der;
  longer.push_back(0);
  CHECK_FALSE(Certificate::from_der(longer));
}

TEST_CASE("a certificate with one flipped bit is not accepted as signed by the authority") {
  const Fixture f;
  const std::vector<std::uint8_t> der = f.certificate.der();
  const std::uint64_t seed = 44;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    std::vector<std::uint8_t> changed = der;
    const std::size_t bit = rng.below(8 * der.size());
    CAPTURE(bit);
    changed[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    const auto certificate = Certificate::from_der(changed);
    CHECK_FALSE((certificate && certificate->is_issued_by(f.authority.certificate())));
  }
}

TEST_CASE("different identities have different prefixes, whose first bit is set") {
  const Fixture f;
  std::set<CertifiedPrefix> prefixes;
  for (std::uint32_t robot = 0; robot < 30; ++robot) {
    const auto prefix =
        f.authority.issue({Role::kAgent, robot, robot}, make_private_key(), f.now, f.now + hours(1)).prefix();
    CHECK((prefix[0] & 0x80) != 0);
    prefixes.insert(prefix);
  }
  CHECK(prefixes.size() == 30);
}

TEST_CASE("only the authority can make a revocation list, which contains the revoked serial numbers") {
  const Fixture f;
  const Authority other("identity authority", f.now, f.now + hours(24));
  const TemporaryFolder folder;
  const std::string file = folder.file("crl.pem");
  const std::set<std::string> serials{f.certificate.serial(), "7b", other.certificate().serial()};
  write_file(file, f.authority.revocation_list(serials, f.now, f.now + hours(24)));
  CHECK(load_revoked_serials(file, f.authority.certificate()) == serials);
  CHECK_THROWS_WITH(load_revoked_serials(file, other.certificate()),
                    ContainsSubstring("another authority has signed"));
  write_file(file, f.authority.revocation_list({}, f.now, f.now + hours(24)));
  CHECK(load_revoked_serials(file, f.authority.certificate()).empty());
  write_file(file, "nonsense");
  CHECK_THROWS_WITH(load_revoked_serials(file, f.authority.certificate()),
                    ContainsSubstring("crl.pem: expected a list"));
  CHECK_THROWS_WITH(Certificate::load(file), ContainsSubstring("crl.pem: expected a certificate"));
  CHECK_THROWS_WITH(Certificate::load(folder.file("none")), ContainsSubstring("cannot read"));
}

}  // namespace sidestep::certificate_test
