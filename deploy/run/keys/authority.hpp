// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <set>
#include <string>

#include "common/keys/certificate.hpp"
#include "common/keys/private_key.hpp"

namespace sidestep {

/// Creates a private key on the curve P-256.
[[nodiscard]] PrivateKey make_private_key();
[[nodiscard]] std::string to_pem(const PrivateKey& key);
[[nodiscard]] std::string to_pem(const Certificate& certificate);

/// A certificate authority: its own certificate, and the private key with which it signs. The functions throw
/// std::runtime_error if OpenSSL fails.
class Authority {
 public:
  /// Creates a new authority.
  Authority(const std::string& name, Time from, Time until);
  /// Loads an authority from PEM files. Throws std::invalid_argument with the file and what is wrong.
  Authority(const std::string& certificate_file, const std::string& key_file);

  const Certificate& certificate() const { return certificate_; }
  const PrivateKey& key() const { return key_; }

  /// Issues a certificate to the owner of a private key, named by the identity.
  [[nodiscard]] Certificate issue(const Identity& identity, const PrivateKey& key, Time from,
                                  Time until) const;
  /// A signed list of revoked serial numbers (CRL, PEM).
  [[nodiscard]] std::string revocation_list(const std::set<std::string>& serials, Time from,
                                            Time until) const;
  /// Signs a document in the form that DDS Security requires (S/MIME).
  [[nodiscard]] std::string sign(const std::string& document) const;

 private:
  PrivateKey key_;
  Certificate certificate_;
};

}  // namespace sidestep
