// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/keys/certificate.hpp"

namespace sidestep {

/// The files in the folder of one identity, as `sidestep keys issue` writes them and ROS 2's sros2 names
/// them.
namespace key_files {

inline constexpr const char* kCertificate = "cert.pem";
inline constexpr const char* kPrivateKey = "key.pem";
inline constexpr const char* kIdentityAuthority = "identity_ca.cert.pem";
inline constexpr const char* kPermissionsAuthority = "permissions_ca.cert.pem";
inline constexpr const char* kRevoked = "crl.pem";
inline constexpr const char* kGovernance = "governance.p7s";
inline constexpr const char* kPermissions = "permissions.p7s";

/// All of them.
inline constexpr const char* kAll[] = {kCertificate, kPrivateKey, kIdentityAuthority, kPermissionsAuthority,
                                       kRevoked,     kGovernance, kPermissions};

}  // namespace key_files

/// The keys of one identity.
struct KeyFolder {
  std::string path;
  Identity identity;
  Certificate certificate, authority;  ///< the latter has issued the certificates of all identities

  std::string file(const char* name) const { return path + "/" + name; }
};

/// Loads the keys of one identity and checks all that the identity itself can check of them. Throws
/// std::invalid_argument that says what is wrong: a file is missing or this user may not read it, the
/// certificate has expired or is revoked, the private key is another's, other users may read it, or another
/// authority has signed a document. Throws std::runtime_error if a part is not valid yet: the host's clock
/// may not be set yet.
[[nodiscard]] KeyFolder load_key_folder(const std::string& path, Time now);

/// The folder with the keys of an identity, in one that `sidestep keys init` has made; of robots, one whose
/// keys cover them. Throws std::invalid_argument if there is none.
[[nodiscard]] std::string key_folder_of(const std::string& store, const Identity& identity);

/// As key_folder_of(), but `path` may also be the folder with the keys of one identity, of whomever.
[[nodiscard]] std::string own_key_folder(const std::string& path, const Identity& identity);

/// The time in UTC, in a format of strftime() that gives at most 63 characters.
[[nodiscard]] std::string utc_text(Time time, const char* format);
/// "2026-11-26 14:03 UTC"
[[nodiscard]] std::string date_text(Time time);

}  // namespace sidestep
