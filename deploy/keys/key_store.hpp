// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/keys/certificate.hpp"
#include "deploy/keys/authority.hpp"

namespace sidestep {

/// A key that has been issued.
struct IssuedKey {
  std::string name;  ///< of the identity; empty if its certificate cannot be read
  std::string serial;
  Time not_after{};
  bool is_revoked = false;
  std::string problem = {};  ///< why its certificate cannot be read; empty: it can
};

/// The keys of an identity when it was revoked.
struct Revocation {
  Identity identity;
  std::size_t revoked = 0;  ///< by this call
  std::size_t before = 0;   ///< were revoked already
};

/// A folder with two certificate authorities and the keys of all identities, laid out as ROS 2's sros2 does:
/// `public` (certificates, the list of revoked keys), `private` (the authorities' keys) and `enclaves/NAME`.
/// There are two authorities because Fast DDS 2.9.1 accepts permissions that a certificate of the same
/// authority has signed (CVE-2023-24010). The functions throw std::invalid_argument if the folder does not
/// allow what is asked, and std::runtime_error if files cannot be written. Processes that change the folder
/// wait for each other; one that is killed leaves what it had finished.
class KeyStore {
 public:
  /// Makes a new folder. An existing folder must be empty.
  static void create(const std::string& folder, Time now, Time until);
  /// Opens a folder that create() has made.
  explicit KeyStore(const std::string& folder);

  /// Makes a key, and so replaces an earlier one of this identity, which stays valid until it is revoked or
  /// expires. Returns the folder of the identity.
  std::string issue(const Identity& identity, Time now, Time until);
  /// Revokes all keys of these identities, in one new list of revoked keys that is read back, and removes
  /// their folders. Returns what was done for each, in this order.
  std::vector<Revocation> revoke(std::span<const Identity> identities, Time now);
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
