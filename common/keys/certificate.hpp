// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/keys/identity.hpp"
#include "common/time/time.hpp"

struct x509_st;

namespace sidestep {

/// The first bytes of the GUID of a participant with a certificate: DDS Security 1.1, 9.3.3, derives them
/// from the certificate's subject, and participants check those of each other.
using CertifiedPrefix = std::array<std::uint8_t, 6>;

/// The organisation in the subjects of our certificates.
inline constexpr const char* kOrganisation = "Sidestep";

/// From when until when something may be used.
struct Validity {
  Time from, until;
};

/// An X.509 certificate.
class Certificate {
 public:
  explicit Certificate(std::shared_ptr<x509_st> x509) : x509_(std::move(x509)) {}

  /// Untrusted bytes, DER; nullopt if they are no certificate.
  [[nodiscard]] static std::optional<Certificate> from_der(std::span<const std::uint8_t> bytes);
  /// From a PEM file. Throws std::invalid_argument with the file and what is wrong.
  static Certificate load(const std::string& path);

  /// Whether the authority has signed it.
  [[nodiscard]] bool is_issued_by(const Certificate& authority) const;
  /// Whether the owner of the certificate's private key has signed these bytes, see sign().
  [[nodiscard]] bool has_signed(std::span<const std::uint8_t> bytes,
                                std::span<const std::uint8_t> signature) const;
  /// nullopt: its subject is not one of ours.
  std::optional<Identity> identity() const;
  /// In RFC 2253 order: "CN=agent 3,O=Sidestep".
  std::string subject() const;
  std::string serial() const;  ///< hexadecimal
  Time not_before() const;
  Time not_after() const;
  Validity validity() const { return {not_before(), not_after()}; }
  CertifiedPrefix prefix() const;
  /// The prefix of the GUID that a participant with this certificate has, if `candidate` is what it would
  /// have without.
  std::array<std::uint8_t, 12> guid_prefix(const std::array<std::uint8_t, 12>& candidate) const;
  std::vector<std::uint8_t> der() const;
  x509_st* x509() const { return x509_.get(); }

 private:
  std::shared_ptr<x509_st> x509_;
};

/// Which certificates an authority has revoked (a CRL, RFC 5280).
struct RevocationList {
  std::set<std::string> serials;
  Validity validity;
};

/// Reads a list of revoked certificates from a PEM file. Throws std::invalid_argument with the file and what
/// is wrong, e.g. that another authority has signed it.
RevocationList load_revocation_list(const std::string& path, const Certificate& authority);

/// The serial numbers of a list that load_revocation_list() reads; throws as it does.
std::set<std::string> load_revoked_serials(const std::string& path, const Certificate& authority);

}  // namespace sidestep
