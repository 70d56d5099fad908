// SPDX-License-Identifier: Apache-2.0
#include "deploy/keys/key_store.hpp"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>
#include <system_error>
#include <unistd.h>

#include "common/file/write_file.hpp"
#include "common/keys/key_folder.hpp"
#include "deploy/keys/permissions_text.hpp"

namespace sidestep {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIdentityKey = "identity_ca.key.pem";
constexpr const char* kPermissionsKey = "permissions_ca.key.pem";
/// Copies of all certificates that have been issued: public/issued/SERIAL.pem.
constexpr const char* kIssued = "issued";

/// A file that only this user may read. It is never readable by others, not even for a moment.
void write_private_file(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool is_written = file >= 0 &&
                          write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                          fsync(file) == 0;
  const int error = errno;
  if (file >= 0) close(file);
  if (!is_written) throw std::system_error(error, std::generic_category(), "cannot write " + path);
}

/// Replaces a file or link by a link to a file of the folder `public`.
void link_public_file(const std::string& folder, const char* name) {
  const fs::path link = folder + "/" + name;
  fs::remove(link);
  fs::create_symlink(fs::path("../../public") / name, link);
}

std::set<std::string> revoked_serials(const std::string& folder) {
  const Certificate authority = Certificate::load(folder + "/public/" + key_files::kIdentityAuthority);
  return load_revoked_serials(folder + "/public/" + key_files::kRevoked, authority);
}

Authority identity_authority(const std::string& folder) {
  return Authority(folder + "/public/" + key_files::kIdentityAuthority, folder + "/private/" + kIdentityKey);
}

}  // namespace

void KeyStore::create(const std::string& folder, Time now, Time until) {
  std::error_code none;
  if (fs::exists(folder, none) && (!fs::is_directory(folder, none) || !fs::is_empty(folder, none)))
    throw std::invalid_argument(folder + " exists and is not an empty folder; keys are never overwritten");
  fs::create_directories(folder + "/public/" + kIssued);
  fs::create_directories(folder + "/private");
  fs::create_directories(folder + "/enclaves");
  fs::permissions(folder + "/private", fs::perms::owner_all);
  fs::permissions(folder + "/enclaves", fs::perms::owner_all);
  const Authority identities("identity authority", now, until),
      permissions("permissions authority", now, until);
  write_private_file(folder + "/private/" + kIdentityKey, to_pem(identities.key()));
  write_private_file(folder + "/private/" + kPermissionsKey, to_pem(permissions.key()));
  const std::string publicly = folder + "/public/";
  write_file(publicly + key_files::kIdentityAuthority, to_pem(identities.certificate()));
  write_file(publicly + key_files::kPermissionsAuthority, to_pem(permissions.certificate()));
  write_file(publicly + key_files::kGovernance, permissions.sign(governance_text()));
  write_file(publicly + key_files::kRevoked, identities.revocation_list({}, now, until));
}

KeyStore::KeyStore(const std::string& folder) : folder_(folder) {
  std::error_code none;
  if (!fs::exists(private_file(kIdentityKey), none))
    throw std::invalid_argument(
        fmt::format("expected a folder that `sidestep keys init` has made, but {} does not exist",
                    private_file(kIdentityKey)));
}

std::string KeyStore::issue(const Identity& identity, Time now, Time until) {
  const Authority identities = identity_authority(folder_);
  const Authority permissions(public_file(key_files::kPermissionsAuthority), private_file(kPermissionsKey));
  // Fast DDS checks the authorities only as long as they are valid.
  until = std::min({until, identities.certificate().not_after(), permissions.certificate().not_after()});
  if (until <= now)
    throw std::invalid_argument(
        fmt::format("the authorities in {} expired on {}; make new keys in another folder", folder_,
                    date_text(authorities_expire())));
  const PrivateKey key = make_private_key();
  const Certificate certificate = identities.issue(identity, key, now, until);
  const std::string folder = folder_ + "/enclaves/" + folder_name(identity);
  fs::create_directories(folder);
  fs::permissions(folder, fs::perms::owner_all);
  for (const char* name : {key_files::kIdentityAuthority, key_files::kPermissionsAuthority,
                           key_files::kRevoked, key_files::kGovernance})
    link_public_file(folder, name);
  write_file(public_file(fmt::format("{}/{}.pem", kIssued, certificate.serial())), to_pem(certificate));
  write_file(folder + "/" + key_files::kPermissions,
             permissions.sign(permissions_text(identity, certificate.subject(), now, until)));
  fs::remove(folder + "/" + key_files::kPrivateKey);
  write_private_file(folder + "/" + key_files::kPrivateKey, to_pem(key));
  write_file(folder + "/" + key_files::kCertificate, to_pem(certificate));
  return folder;
}

std::size_t KeyStore::revoke(const Identity& identity, Time now) {
  std::set<std::string> serials = revoked_serials(folder_);
  std::size_t count = 0;
  for (const IssuedKey& key : keys()) {
    if (key.name == to_text(identity) && serials.insert(key.serial).second) ++count;
  }
  if (count == 0)
    throw std::invalid_argument(
        fmt::format("no valid key was issued for {}; `sidestep keys show` lists all", to_text(identity)));
  const Authority identities = identity_authority(folder_);
  write_file(public_file(key_files::kRevoked),
             identities.revocation_list(serials, now, identities.certificate().not_after()));
  fs::remove_all(folder_ + "/enclaves/" + folder_name(identity));
  return count;
}

std::vector<IssuedKey> KeyStore::keys() const {
  const std::set<std::string> serials = revoked_serials(folder_);
  std::vector<IssuedKey> result;
  for (const auto& entry : fs::directory_iterator(public_file(kIssued))) {
    const Certificate certificate = Certificate::load(entry.path().string());
    const auto identity = certificate.identity();
    result.push_back({identity ? to_text(*identity) : certificate.subject(), certificate.serial(),
                      certificate.not_after(), serials.count(certificate.serial()) > 0});
  }
  std::ranges::sort(result, [](const IssuedKey& a, const IssuedKey& b) {
    return std::tie(a.name, a.not_after, a.serial) < std::tie(b.name, b.not_after, b.serial);
  });
  return result;
}

bool KeyStore::has(const Identity& identity) const {
  std::error_code none;
  return fs::exists(folder_ + "/enclaves/" + folder_name(identity) + "/" + key_files::kCertificate, none);
}

Time KeyStore::authorities_expire() const {
  return std::min(Certificate::load(public_file(key_files::kIdentityAuthority)).not_after(),
                  Certificate::load(public_file(key_files::kPermissionsAuthority)).not_after());
}

}  // namespace sidestep
