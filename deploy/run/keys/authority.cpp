// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/keys/authority.hpp"

#include <array>
#include <ctime>
#include <fmt/format.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <stdexcept>

namespace sidestep {
namespace {

using Bio = std::unique_ptr<BIO, decltype(&BIO_free_all)>;

void require(bool is_good) {
  if (is_good) return;
  std::array<char, 256> text{};
  ERR_error_string_n(ERR_get_error(), text.data(), text.size());
  throw std::runtime_error(fmt::format("OpenSSL: {}", text.data()));
}

std::string text_in(const Bio& bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

std::time_t seconds_of(Time time) {
  return std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count();
}

std::shared_ptr<X509_NAME> subject_name(const std::string& common_name) {
  std::shared_ptr<X509_NAME> name(X509_NAME_new(), X509_NAME_free);
  const auto add = [&](const char* field, const std::string& value) {
    require(X509_NAME_add_entry_by_txt(name.get(), field, MBSTRING_UTF8,
                                       reinterpret_cast<const unsigned char*>(value.c_str()), -1, -1,
                                       0) == 1);
  };
  add("O", kOrganisation);
  add("CN", common_name);
  return name;
}

void set_random_serial(X509* certificate) {
  std::array<unsigned char, 16> bytes{};
  require(RAND_bytes(bytes.data(), bytes.size()) == 1);
  // Makes the number positive and of full length.
  bytes[0] = static_cast<unsigned char>((bytes[0] & 0x7f) | 0x40);
  const std::unique_ptr<BIGNUM, decltype(&BN_free)> number(BN_bin2bn(bytes.data(), bytes.size(), nullptr),
                                                           BN_free);
  require(BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate)) != nullptr);
}

void add_extension(X509* certificate, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  const std::unique_ptr<X509_EXTENSION, decltype(&X509_EXTENSION_free)> extension(
      X509V3_EXT_conf_nid(nullptr, &context, kind, value), X509_EXTENSION_free);
  require(extension && X509_add_ext(certificate, extension.get(), -1) == 1);
}

/// A certificate for `key`, signed by `authority_key` in the name `issuer`.
Certificate make_certificate(X509_NAME* subject, const PrivateKey& key, const X509_NAME* issuer,
                             const PrivateKey& authority_key, bool is_authority, Time from, Time until) {
  std::shared_ptr<X509> x509(X509_new(), X509_free);
  require(X509_set_version(x509.get(), 2) == 1);  // X.509 version 3
  set_random_serial(x509.get());
  require(X509_set_subject_name(x509.get(), subject) == 1 && X509_set_issuer_name(x509.get(), issuer) == 1 &&
          X509_set_pubkey(x509.get(), key.get()) == 1);
  require(ASN1_TIME_set(X509_getm_notBefore(x509.get()), seconds_of(from)) != nullptr &&
          ASN1_TIME_set(X509_getm_notAfter(x509.get()), seconds_of(until)) != nullptr);
  add_extension(x509.get(), NID_basic_constraints, is_authority ? "critical,CA:TRUE" : "critical,CA:FALSE");
  add_extension(x509.get(), NID_key_usage,
                is_authority ? "critical,keyCertSign,cRLSign,digitalSignature" : "critical,digitalSignature");
  require(X509_sign(x509.get(), authority_key.get(), EVP_sha256()) > 0);
  return Certificate(x509);
}

}  // namespace

PrivateKey make_private_key() {
  PrivateKey key(EVP_EC_gen("P-256"), EVP_PKEY_free);
  require(key != nullptr);
  return key;
}

std::string to_pem(const PrivateKey& key) {
  const Bio bio(BIO_new(BIO_s_mem()), BIO_free_all);
  require(PEM_write_bio_PrivateKey(bio.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1);
  return text_in(bio);
}

std::string to_pem(const Certificate& certificate) {
  const Bio bio(BIO_new(BIO_s_mem()), BIO_free_all);
  require(PEM_write_bio_X509(bio.get(), certificate.x509()) == 1);
  return text_in(bio);
}

Authority::Authority(const std::string& name, Time from, Time until)
    : key_(make_private_key()), certificate_(nullptr) {
  const auto subject = subject_name(name);
  certificate_ = make_certificate(subject.get(), key_, subject.get(), key_, true, from, until);
}

Authority::Authority(const std::string& certificate_file, const std::string& key_file)
    : key_(load_private_key(key_file)), certificate_(Certificate::load(certificate_file)) {
  if (X509_check_private_key(certificate_.x509(), key_.get()) != 1)
    throw std::invalid_argument(key_file + ": this private key does not belong to " + certificate_file);
}

Certificate Authority::issue(const Identity& identity, const PrivateKey& key, Time from, Time until) const {
  return make_certificate(subject_name(to_text(identity)).get(), key,
                          X509_get_subject_name(certificate_.x509()), key_, false, from, until);
}

std::string Authority::revocation_list(const std::set<std::string>& serials, Time from, Time until) const {
  const std::unique_ptr<X509_CRL, decltype(&X509_CRL_free)> list(X509_CRL_new(), X509_CRL_free);
  const std::unique_ptr<ASN1_TIME, decltype(&ASN1_TIME_free)> begin(ASN1_TIME_set(nullptr, seconds_of(from)),
                                                                    ASN1_TIME_free),
      end(ASN1_TIME_set(nullptr, seconds_of(until)), ASN1_TIME_free);
  require(X509_CRL_set_version(list.get(), 1) == 1 &&
          X509_CRL_set_issuer_name(list.get(), X509_get_subject_name(certificate_.x509())) == 1 &&
          X509_CRL_set1_lastUpdate(list.get(), begin.get()) == 1 &&
          X509_CRL_set1_nextUpdate(list.get(), end.get()) == 1);
  for (const std::string& serial : serials) {
    BIGNUM* number = nullptr;
    require(BN_hex2bn(&number, serial.c_str()) > 0);
    const std::unique_ptr<BIGNUM, decltype(&BN_free)> owned(number, BN_free);
    const std::unique_ptr<ASN1_INTEGER, decltype(&ASN1_INTEGER_free)> integer(
        BN_to_ASN1_INTEGER(number, nullptr), ASN1_INTEGER_free);
    X509_REVOKED* const revoked = X509_REVOKED_new();
    require(X509_REVOKED_set_serialNumber(revoked, integer.get()) == 1 &&
            X509_REVOKED_set_revocationDate(revoked, begin.get()) == 1 &&
            X509_CRL_add0_revoked(list.get(), revoked) == 1);
  }
  require(X509_CRL_sort(list.get()) == 1 && X509_CRL_sign(list.get(), key_.get(), EVP_sha256()) > 0);
  const Bio bio(BIO_new(BIO_s_mem()), BIO_free_all);
  require(PEM_write_bio_X509_CRL(bio.get(), list.get()) == 1);
  return text_in(bio);
}

std::string Authority::sign(const std::string& document) const {
  const Bio in(BIO_new_mem_buf(document.data(), static_cast<int>(document.size())), BIO_free_all),
      out(BIO_new(BIO_s_mem()), BIO_free_all);
  constexpr int kFlags = PKCS7_TEXT | PKCS7_DETACHED | PKCS7_STREAM;
  const std::unique_ptr<PKCS7, decltype(&PKCS7_free)> signature(
      PKCS7_sign(certificate_.x509(), key_.get(), nullptr, in.get(), kFlags), PKCS7_free);
  require(signature != nullptr);
  require(SMIME_write_PKCS7(out.get(), signature.get(), in.get(), kFlags) == 1);
  return text_in(out);
}

}  // namespace sidestep
