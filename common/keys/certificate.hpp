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

/// The first bytes of a certified participant's GUID. They are derived from the certificate's subject (DDS
/// Security 1.1, 9.3.3), and participants check each other's prefix.
using CertifiedPrefix = std::array<std::uint8_t, 6>;

/// The organisation in the subjects of our certificates.
inline constexpr const char* kOrganisation = "Sidestep";

/// The period in which a certificate or document is valid.
struct ValidityPeriod {
  Time from, until;
};

/// An X.509 certificate.
class Certificate {
 public:
  explicit Certificate(std::shared_ptr<x509_st> x509) : x509_(std::move(x509)) {}

  /// Decodes untrusted DER bytes; nullopt if they are not a certificate.
  [[nodiscard]] static std::optional<Certificate> from_der(std::span<const std::uint8_t> bytes);
  /// Loads a PEM file. Throws std::invalid_argument that names the file and the problem.
  static Certificate load(const std::string& path);

  /// Whether the authority has signed this certificate.
  [[nodiscard]] bool is_issued_by(const Certificate& authority) const;
  /// Whether these bytes were signed by the owner of the certificate's private key, see sign().
  [[nodiscard]] bool has_signed(std::span<const std::uint8_t> bytes,
                                std::span<const std::uint8_t> signature) const;
  /// nullopt if its subject is not one of Sidestep's identities.
  std::optional<Identity> identity() const;
  /// The subject in RFC 2253 order: "CN=agent 3,O=Sidestep".
  std::string subject() const;
  std::string serial() const;  ///< The serial number, in hexadecimal.
  Time not_before() const;
  Time not_after() const;
  ValidityPeriod validity() const { return {not_before(), not_after()}; }
  CertifiedPrefix prefix() const;
  /// The GUID prefix of a participant with this certificate. `candidate` is the prefix that the participant
  /// would have without a certificate.
  std::array<std::uint8_t, 12> guid_prefix(const std::array<std::uint8_t, 12>& candidate) const;
  std::vector<std::uint8_t> der() const;
  x509_st* x509() const { return x509_.get(); }

 private:
  std::shared_ptr<x509_st> x509_;
};

/// The certificates that an authority has revoked (a CRL, RFC 5280).
struct RevocationList {
  std::set<std::string> serials;
  ValidityPeriod validity;
};

/// Reads a list of revoked certificates from a PEM file. Throws std::invalid_argument that names the file and
/// the problem, for example that another authority has signed it.
RevocationList load_revocation_list(const std::string& path, const Certificate& authority);

/// The serial numbers in a revocation list. Throws in the same cases as load_revocation_list().
std::set<std::string> load_revoked_serials(const std::string& path, const Certificate& authority);

}  // namespace sidestep
