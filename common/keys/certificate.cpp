// SPDX-License-Identifier: Apache-2.0
#include "common/keys/certificate.hpp"

#include <algorithm>
#include <ctime>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <stdexcept>

#include "common/keys/key_file.hpp"

namespace sidestep {
namespace {

using File = std::unique_ptr<BIO, decltype(&BIO_free_all)>;

std::string hexadecimal(const ASN1_INTEGER* number) {
  std::string result;
  for (int i = 0; i < number->length; ++i) result += fmt::format("{:02x}", number->data[i]);
  return result;
}

Time to_time(const ASN1_TIME* time) {
  std::tm parts{};
  if (ASN1_TIME_to_tm(time, &parts) != 1) return Time{};
  return Time{} + std::chrono::seconds(timegm(&parts));
}

/// The value of an attribute of the subject; empty unless the attribute occurs exactly once.
std::string part_of(const X509_NAME* name, int nid) {
  const int index = X509_NAME_get_index_by_NID(name, nid, -1);
  if (index < 0 || X509_NAME_get_index_by_NID(name, nid, index) >= 0) return {};
  const ASN1_STRING* const value = X509_NAME_ENTRY_get_data(X509_NAME_get_entry(name, index));
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(value)),
          static_cast<std::size_t>(ASN1_STRING_length(value))};
}

}  // namespace

std::optional<Certificate> Certificate::from_der(std::span<const std::uint8_t> bytes) {
  const unsigned char* next = bytes.data();
  std::shared_ptr<X509> x509(d2i_X509(nullptr, &next, static_cast<long>(bytes.size())), X509_free);
  if (!x509 || next != bytes.data() + bytes.size()) return std::nullopt;
  return Certificate(std::move(x509));
}

Certificate Certificate::load(const std::string& path) {
  const auto file = open_key_file(path);
  std::shared_ptr<X509> x509(PEM_read_bio_X509(file.get(), nullptr, nullptr, nullptr), X509_free);
  if (!x509) throw std::invalid_argument(path + ": expected a certificate (PEM)");
  return Certificate(std::move(x509));
}

bool Certificate::is_issued_by(const Certificate& authority) const {
  return X509_check_issued(authority.x509(), x509_.get()) == X509_V_OK &&
         X509_verify(x509_.get(), X509_get0_pubkey(authority.x509())) == 1;
}

bool Certificate::has_signed(std::span<const std::uint8_t> bytes,
                             std::span<const std::uint8_t> signature) const {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  EVP_PKEY* const key = X509_get0_pubkey(x509_.get());
  return context && key != nullptr &&
         EVP_DigestVerifyInit(context.get(), nullptr, EVP_sha256(), nullptr, key) == 1 &&
         EVP_DigestVerify(context.get(), signature.data(), signature.size(), bytes.data(), bytes.size()) == 1;
}

std::optional<Identity> Certificate::identity() const {
  const X509_NAME* const name = X509_get_subject_name(x509_.get());
  if (X509_NAME_entry_count(name) != 2 || part_of(name, NID_organizationName) != kOrganisation)
    return std::nullopt;
  return parse_identity(part_of(name, NID_commonName));
}

std::string Certificate::subject() const {
  const File text(BIO_new(BIO_s_mem()), BIO_free_all);
  X509_NAME_print_ex(text.get(), X509_get_subject_name(x509_.get()), 0, XN_FLAG_RFC2253);
  char* data = nullptr;
  const long size = BIO_get_mem_data(text.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

std::string Certificate::serial() const { return hexadecimal(X509_get0_serialNumber(x509_.get())); }

Time Certificate::not_before() const { return to_time(X509_get0_notBefore(x509_.get())); }
Time Certificate::not_after() const { return to_time(X509_get0_notAfter(x509_.get())); }

CertifiedPrefix Certificate::prefix() const {
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  unsigned size = 0;
  X509_NAME_digest(X509_get_subject_name(x509_.get()), EVP_sha256(), hash.data(), &size);
  // The first bit is set; the first 47 bits of the hash follow.
  CertifiedPrefix result;
  std::uint8_t carried = 1;
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = static_cast<std::uint8_t>(carried << 7 | hash[i] >> 1);
    carried = hash[i] & 1;
  }
  return result;
}

std::array<std::uint8_t, 12> Certificate::guid_prefix(const std::array<std::uint8_t, 12>& candidate) const {
  // The hash covers the whole GUID, including the entity id that stands for a participant.
  std::array<std::uint8_t, 16> guid{};
  std::ranges::copy(candidate, guid.begin());
  guid[14] = 1;
  guid[15] = 0xc1;
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  unsigned size = 0;
  EVP_Digest(guid.data(), guid.size(), hash.data(), &size, EVP_sha256(), nullptr);
  const CertifiedPrefix certified = prefix();
  std::array<std::uint8_t, 12> result{};
  const auto rest = std::ranges::copy(certified, result.begin()).out;
  std::copy_n(hash.begin(), result.end() - rest, rest);
  return result;
}

std::vector<std::uint8_t> Certificate::der() const {
  std::vector<std::uint8_t> result(static_cast<std::size_t>(i2d_X509(x509_.get(), nullptr)));
  unsigned char* next = result.data();
  i2d_X509(x509_.get(), &next);
  return result;
}

RevocationList load_revocation_list(const std::string& path, const Certificate& authority) {
  const auto file = open_key_file(path);
  const std::unique_ptr<X509_CRL, decltype(&X509_CRL_free)> list(
      PEM_read_bio_X509_CRL(file.get(), nullptr, nullptr, nullptr), X509_CRL_free);
  if (!list) throw std::invalid_argument(path + ": expected a list of revoked certificates (PEM)");
  if (X509_CRL_verify(list.get(), X509_get0_pubkey(authority.x509())) != 1)
    throw std::invalid_argument(path + ": another authority has signed this list of revoked certificates");
  RevocationList result;
  const STACK_OF(X509_REVOKED)* const revoked = X509_CRL_get_REVOKED(list.get());
  for (int i = 0; i < sk_X509_REVOKED_num(revoked); ++i)
    result.serials.insert(hexadecimal(X509_REVOKED_get0_serialNumber(sk_X509_REVOKED_value(revoked, i))));
  const ASN1_TIME* const until = X509_CRL_get0_nextUpdate(list.get());
  result.validity = {to_time(X509_CRL_get0_lastUpdate(list.get())),
                     until == nullptr ? Time::max() : to_time(until)};
  return result;
}

std::set<std::string> load_revoked_serials(const std::string& path, const Certificate& authority) {
  return load_revocation_list(path, authority).serials;
}

}  // namespace sidestep
