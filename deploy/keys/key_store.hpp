// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/keys/certificate.hpp"
#include "deploy/keys/authority.hpp"

namespace sidestep {

/// A key that has been issued.
struct IssuedKey {
  std::string name;  ///< of the identity
  std::string serial;
  Time not_after;
  bool is_revoked = false;
};

/// A folder with two certificate authorities and the keys of all identities, laid out as ROS 2's sros2 does:
/// `public` (certificates, the list of revoked keys), `private` (the authorities' keys) and `enclaves/NAME`.
/// There are two authorities because Fast DDS 2.9.1 accepts permissions that a certificate of the same
/// authority has signed (CVE-2023-24010). The functions throw std::invalid_argument if the folder does not
/// allow what is asked, and std::runtime_error if files cannot be written.
class KeyStore {
 public:
  /// Makes a new folder. An existing folder must be empty.
  static void create(const std::string& folder, Time now, Time until);
  /// Opens a folder that create() has made.
  explicit KeyStore(const std::string& folder);

  /// Makes a key, and so replaces an earlier one of this identity, which stays valid until it is revoked or
  /// expires. Returns the folder of the identity.
  std::string issue(const Identity& identity, Time now, Time until);
  /// Revokes all keys of an identity that have been issued, and removes its folder. Returns how many.
  std::size_t revoke(const Identity& identity, Time now);
  /// All keys that have been issued, sorted by name.
  std::vector<IssuedKey> keys() const;
  bool has(const Identity& identity) const;
  Time authorities_expire() const;

 private:
  std::string public_file(const std::string& name) const { return folder_ + "/public/" + name; }
  std::string private_file(const std::string& name) const { return folder_ + "/private/" + name; }

  std::string folder_;
};

}  // namespace sidestep
