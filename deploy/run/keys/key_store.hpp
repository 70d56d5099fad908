// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/keys/certificate.hpp"
#include "deploy/run/keys/authority.hpp"

namespace sidestep {

/// An issued key.
struct IssuedKey {
  std::string name;  ///< name of the identity; empty if its certificate cannot be read
  std::string serial;
  Time not_after{};
  bool is_revoked = false;
  std::string problem = {};  ///< why its certificate cannot be read; empty if it can
};

/// The result of revoking an identity's keys.
struct Revocation {
  Identity identity;
  std::size_t revoked = 0;  ///< number of keys revoked by this call
  std::size_t before = 0;   ///< number of keys that were already revoked
};

/// A folder with two certificate authorities and the keys of all identities. Its layout is that of ROS 2's
/// sros2: `public` (certificates, the list of revoked keys), `private` (the authorities' keys) and
/// `enclaves/NAME` (one folder per identity). There are two authorities because Fast DDS 2.9.1 accepts
/// permissions signed with any certificate of the same authority (CVE-2023-24010). The functions throw
/// std::invalid_argument if the state of the folder does not permit the operation, and std::runtime_error if
/// files cannot be written. Processes that change the folder wait for each other; if one is killed, what it
/// has completed remains.
class KeyStore {
 public:
  /// Creates a new store. If the folder exists, it must be empty.
  static void create(const std::string& folder, Time now, Time until);
  /// Opens a folder that create() has made.
  explicit KeyStore(const std::string& folder);

  /// Issues a key. It replaces an earlier key of this identity, which stays valid until it is revoked or
  /// expires. Returns the folder of the identity.
  std::string issue(const Identity& identity, Time now, Time until);
  /// Revokes all keys of these identities in a single new list of revoked keys, which is read back for
  /// verification, and removes their folders. The list stays as it is if it has them already. Returns the
  /// results in the same order.
  std::vector<Revocation> revoke(std::span<const Identity> identities, Time now);
  /// All issued keys, sorted by name.
  std::vector<IssuedKey> keys() const;
  bool has(const Identity& identity) const;
  Time authorities_expire() const;

 private:
  void write_revoked(const std::set<std::string>& serials, Time now);
  std::string public_file(const std::string& name) const { return folder_ + "/public/" + name; }
  std::string private_file(const std::string& name) const { return folder_ + "/private/" + name; }

  std::string folder_;
};

}  // namespace sidestep
