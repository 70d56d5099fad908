// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/keys/certificate.hpp"

namespace sidestep {

/// The names of the files in an identity's folder, as `sidestep keys issue` writes them and as ROS 2's sros2
/// names them.
namespace key_files {

inline constexpr const char* kCertificate = "cert.pem";
inline constexpr const char* kPrivateKey = "key.pem";
inline constexpr const char* kIdentityAuthority = "identity_ca.cert.pem";
inline constexpr const char* kPermissionsAuthority = "permissions_ca.cert.pem";
inline constexpr const char* kRevoked = "crl.pem";
inline constexpr const char* kGovernance = "governance.p7s";
inline constexpr const char* kPermissions = "permissions.p7s";
/// In a store's `public`: the folder with copies of all certificates that were issued, named SERIAL.pem.
inline constexpr const char* kIssued = "issued";

/// The names of all files.
inline constexpr const char* kAll[] = {kCertificate, kPrivateKey, kIdentityAuthority, kPermissionsAuthority,
                                       kRevoked,     kGovernance, kPermissions};

}  // namespace key_files

/// The keys of one identity.
struct KeyFolder {
  std::string path;
  Identity identity;
  Certificate certificate, authority;  ///< `authority` has issued the certificates of all identities

  std::string file(const char* name) const { return path + "/" + name; }
};

/// Loads the keys of one identity and performs every check that the identity itself can make. Throws
/// std::invalid_argument with the problem: a file is missing or unreadable for this user, the certificate has
/// expired or is revoked, the private key does not match or other users may read it, or a document was signed
/// by another authority. Throws std::runtime_error if a part is not valid yet: the host's clock may not be
/// set yet.
[[nodiscard]] KeyFolder load_key_folder(const std::string& path, Time now);

/// Throws std::invalid_argument if the governance or the permissions of these keys do not cover the DDS
/// domain. Fast DDS would then create a participant, and refuse each of its topics.
void require_domain(const KeyFolder& keys, int domain);

/// Finds the key folder of an identity inside a folder made by `sidestep keys init`. For a range of robots,
/// finds a folder whose keys cover all of them. Throws std::invalid_argument if there is none.
[[nodiscard]] std::string key_folder_of(const std::string& store, const Identity& identity);

/// Like key_folder_of(), but `path` may also be the key folder of any single identity.
[[nodiscard]] std::string own_key_folder(const std::string& path, const Identity& identity);

/// Formats a time in UTC with a strftime() format whose result has at most 63 characters.
[[nodiscard]] std::string utc_text(Time time, const char* format);
/// A date and time such as "2026-11-26 14:03 UTC".
[[nodiscard]] std::string date_text(Time time);

}  // namespace sidestep
