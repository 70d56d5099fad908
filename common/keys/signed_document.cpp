// SPDX-License-Identifier: Apache-2.0
#include "common/keys/signed_document.hpp"

#include <ctime>
#include <iomanip>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <sstream>
#include <stdexcept>

#include "common/keys/key_file.hpp"

namespace sidestep {
namespace {

using File = std::unique_ptr<BIO, decltype(&BIO_free_all)>;
using Stack = std::unique_ptr<STACK_OF(X509), void (*)(STACK_OF(X509)*)>;

/// The text between the next <name> after a position and its end tag.
std::optional<std::string> element(const std::string& xml, const std::string& name, std::size_t from) {
  const std::string open = "<" + name + ">";
  const auto begin = xml.find(open, from);
  const auto end = xml.find("</" + name + ">", from);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return std::nullopt;
  return xml.substr(begin + open.size(), end - begin - open.size());
}

/// The number in an element; nullopt if there is no such element or it holds something else.
std::optional<int> number_in(const std::string& xml, const std::string& name, std::size_t from) {
  const auto text = element(xml, name, from);
  int result = 0;
  std::string rest;
  if (std::istringstream stream(text.value_or("")); !(stream >> result) || stream >> rest)
    return std::nullopt;
  return result;
}

/// Parses a time such as 2026-11-28T03:00:00 in this host's time zone, as Fast DDS does.
std::optional<Time> parse_time(const std::string& text) {
  std::tm parts{};
  std::istringstream stream(text);
  stream >> std::get_time(&parts, "%Y-%m-%dT%H:%M:%S");
  if (!stream) return std::nullopt;
  return Time{} + std::chrono::seconds(std::mktime(&parts));
}

}  // namespace

std::string load_signed_document(const std::string& path, const Certificate& authority) {
  const auto file = open_key_file(path);
  const File text(BIO_new(BIO_s_mem()), BIO_free_all);
  BIO* detached = nullptr;
  const std::unique_ptr<PKCS7, decltype(&PKCS7_free)> signature(SMIME_read_PKCS7(file.get(), &detached),
                                                                PKCS7_free);
  const File document(detached, BIO_free_all);
  if (!signature || !document) throw std::invalid_argument(path + ": expected a signed document (S/MIME)");
  const Stack signers(sk_X509_new_null(), [](STACK_OF(X509) * stack) { sk_X509_free(stack); });
  sk_X509_push(signers.get(), authority.x509());
  constexpr int kFlags = PKCS7_TEXT | PKCS7_NOINTERN | PKCS7_NOVERIFY;  // accept only the authority's key
  if (PKCS7_verify(signature.get(), signers.get(), nullptr, document.get(), text.get(), kFlags) != 1)
    throw std::invalid_argument(path + ": the permissions authority beside it has not signed this document");
  char* data = nullptr;
  const long size = BIO_get_mem_data(text.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

std::optional<ValidityPeriod> permissions_validity(const std::string& permissions,
                                                   const std::string& subject) {
  const auto grant = permissions.find("<subject_name>" + subject + "</subject_name>");
  if (grant == std::string::npos) return std::nullopt;
  const auto from = element(permissions, "not_before", grant),
             until = element(permissions, "not_after", grant);
  const auto from_time = from ? parse_time(*from) : std::nullopt;
  const auto until_time = until ? parse_time(*until) : std::nullopt;
  if (!from_time || !until_time) return std::nullopt;
  return ValidityPeriod{*from_time, *until_time};
}

bool covers_domain(const std::string& document, int domain) {
  constexpr auto kNone = std::string::npos;
  for (auto at = document.find("<id>"); at != kNone; at = document.find("<id>", at + 1)) {
    if (number_in(document, "id", at) == domain) return true;
  }
  for (auto at = document.find("<id_range>"); at != kNone; at = document.find("<id_range>", at + 1)) {
    const std::string range = element(document, "id_range", at).value_or("");
    const int min = number_in(range, "min", 0).value_or(0), max = number_in(range, "max", 0).value_or(min);
    if (domain >= min && domain <= max) return true;
  }
  return false;
}

}  // namespace sidestep
