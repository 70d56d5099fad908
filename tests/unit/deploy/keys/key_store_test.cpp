// SPDX-License-Identifier: Apache-2.0
#include "deploy/keys/key_store.hpp"

#include <filesystem>
#include <sys/stat.h>

#include "tests/catch.hpp"
#include "tests/test_keys.hpp"

namespace sidestep::key_store_test {

namespace fs = std::filesystem;
using std::chrono::hours;

TEST_CASE("private keys are readable by their owner only") {
  const TestKeys keys({"agent", "3", "judge"});
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(keys.folder())) {
    if (!entry.path().string().ends_with("key.pem")) continue;
    CAPTURE(entry.path());
    CHECK(fs::status(entry.path()).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
    ++count;
  }
  CHECK(count == 4);  // of both authorities and both identities
  CHECK(fs::status(keys.folder() + "/private").permissions() == fs::perms::owner_all);
}

TEST_CASE("the two authorities are different ones") {
  const TestKeys keys({});
  const auto load = [&](const char* name) { return Certificate::load(keys.folder() + "/public/" + name); };
  const Certificate identities = load(key_files::kIdentityAuthority),
                    permissions = load(key_files::kPermissionsAuthority);
  CHECK(identities.subject() != permissions.subject());
  CHECK_FALSE(permissions.is_issued_by(identities));
  CHECK_FALSE(identities.is_issued_by(permissions));
}

TEST_CASE("keys are never overwritten by new authorities") {
  const TestKeys keys({});
  CHECK_THROWS_WITH(KeyStore::create(keys.folder(), keys.now(), keys.now() + hours(1)),
                    ContainsSubstring("keys are never overwritten"));
  CHECK_THROWS_WITH(KeyStore(keys.folder() + "/public"), ContainsSubstring("sidestep keys init"));
}

TEST_CASE("a new key replaces the former, which stays valid until it is revoked") {
  TestKeys keys({"agent", "3"});
  const std::string first = Certificate::load(keys.folder_of("agent 3") + "/cert.pem").serial();
  keys.issue({Role::kAgent, 3, 3});
  const std::string second = Certificate::load(keys.folder_of("agent 3") + "/cert.pem").serial();
  CHECK(first != second);
  REQUIRE(keys.store().keys().size() == 2);
  for (const IssuedKey& key : keys.store().keys()) {
    CHECK(key.name == "agent 3");
    CHECK_FALSE(key.is_revoked);
  }
  CHECK(keys.store().revoke({Role::kAgent, 3, 3}, keys.now()) == 2);
  for (const IssuedKey& key : keys.store().keys()) CHECK(key.is_revoked);
  CHECK_FALSE(keys.store().has({Role::kAgent, 3, 3}));
  CHECK_THROWS_WITH(keys.store().revoke({Role::kAgent, 3, 3}, keys.now()),
                    ContainsSubstring("no valid key was issued for agent 3"));
  // A key that is issued afterwards is valid.
  keys.issue({Role::kAgent, 3, 3});
  CHECK(load_key_folder(keys.folder_of("agent 3"), keys.now()).identity.first == 3);
}

TEST_CASE("revoking one identity leaves all others as they are") {
  TestKeys keys({"agent", "3-4", "vision"});
  keys.store().revoke({Role::kAgent, 4, 4}, keys.now());
  CHECK_NOTHROW(load_key_folder(keys.folder_of("agent 3"), keys.now()));
  CHECK_NOTHROW(load_key_folder(keys.folder_of("vision"), keys.now()));
  CHECK_THROWS(keys.folder_of("agent 4"));
}

TEST_CASE("no key outlives the authorities") {
  TestKeys keys({});
  const std::string folder = keys.issue({Role::kVision}, hours(1000));
  CHECK(Certificate::load(folder + "/cert.pem").not_after() == keys.store().authorities_expire());
  CHECK_THROWS_WITH(keys.store().issue({Role::kJudge}, keys.now() + hours(1000), keys.now() + hours(1001)),
                    ContainsSubstring("the authorities in") && ContainsSubstring("expired on"));
}

}  // namespace sidestep::key_store_test
