// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/keys/key_store.hpp"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

#include "common/file/folder.hpp"
#include "common/file/output_file.hpp"
#include "common/file/permission.hpp"
#include "common/file/write_file.hpp"
#include "common/keys/key_folder.hpp"
#include "deploy/run/keys/permissions_text.hpp"

namespace sidestep {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIdentityKey = "identity_ca.key.pem";
constexpr const char* kPermissionsKey = "permissions_ca.key.pem";

/// Margin of the times in permissions, because Fast DDS interprets them in the host's time zone. The times in
/// the certificate are UTC, and limit how long the key is used.
constexpr std::chrono::hours kTimeZones(24);
/// A handshake sends the permissions in one datagram, with the certificate and the participant's
/// announcement.
constexpr std::size_t kMaxPermissions = 58'000;

constexpr mode_t kPrivate = 0600, kPublic = 0666;  // less the umask

/// Writes a new file to the disk. With kPrivate, no other user can read it at any moment.
void write_new_file(const std::string& path, const std::string& text, mode_t mode) {
  fs::remove(path);
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  const bool is_written = file >= 0 &&
                          write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                          fsync(file) == 0;
  const int error = errno;
  if (file >= 0) close(file);
  if (!is_written) throw_unwritable(path, write_problem(path, error));
}

/// New contents of several files. They are all written beside the files before the first file changes, so a
/// full disk leaves all files as they were.
class FileChanges {
 public:
  FileChanges() = default;
  ~FileChanges() {
    std::error_code none;
    for (const auto& [path, temporary] : written_) fs::remove(temporary, none);
  }
  FileChanges(const FileChanges&) = delete;
  FileChanges& operator=(const FileChanges&) = delete;

  void add(const std::string& path, const std::string& text, mode_t mode) {
    const auto& [file, temporary] = written_.emplace_back(path, fmt::format("{}.{}.tmp", path, getpid()));
    write_new_file(temporary, text, mode);
  }
  void apply() {
    for (const auto& [path, temporary] : written_) fs::rename(temporary, path);
    written_.clear();
  }

 private:
  std::vector<std::pair<std::string, std::string>> written_;  // the files, each with its temporary file
};

/// A lock on the folder of keys: while it exists, no other process changes the folder.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder) {
    const std::string path = folder + "/private/lock";
    file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    int result = file_ < 0 ? -1 : flock(file_, LOCK_EX);
    while (result < 0 && file_ >= 0 && errno == EINTR) result = flock(file_, LOCK_EX);
    if (result == 0) return;
    const int error = errno;
    if (file_ >= 0) close(file_);
    throw std::system_error(error, std::generic_category(), "cannot lock " + path);
  }
  ~FolderLock() { close(file_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

/// Replaces a file or link by a link to a file of the folder `public`.
void link_public_file(const std::string& folder, const char* name) {
  const fs::path link = folder + "/" + name, target = fs::path("../../public") / name;
  std::error_code none;
  if (fs::read_symlink(link, none) == target) return;
  const fs::path temporary = fmt::format("{}.{}.tmp", link.string(), getpid());
  fs::remove(temporary);
  fs::create_symlink(target, temporary);
  fs::rename(temporary, link);
}

void write_authorities(const std::string& folder, Time now, Time until) {
  create_folder(folder + "/public/" + key_files::kIssued);
  create_folder(folder + "/private");
  create_folder(folder + "/enclaves");
  fs::permissions(folder + "/private", fs::perms::owner_all);
  fs::permissions(folder + "/enclaves", fs::perms::owner_all);
  const Authority identities("identity authority", now, until),
      permissions("permissions authority", now, until);
  write_new_file(folder + "/private/" + kIdentityKey, to_pem(identities.key()), kPrivate);
  write_new_file(folder + "/private/" + kPermissionsKey, to_pem(permissions.key()), kPrivate);
  const std::string publicly = folder + "/public/";
  write_file(publicly + key_files::kIdentityAuthority, to_pem(identities.certificate()));
  write_file(publicly + key_files::kPermissionsAuthority, to_pem(permissions.certificate()));
  write_file(publicly + key_files::kGovernance, permissions.sign(governance_text()));
  write_file(publicly + key_files::kRevoked, identities.revocation_list({}, now, until));
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
  const bool is_new = !fs::exists(folder, none);
  create_folder(folder);
  // The parts move to their places only once they are complete.
  const std::string made = fmt::format("{}/{}.tmp", folder, getpid());
  try {
    write_authorities(made, now, until);
    for (const char* part : {"/private", "/public", "/enclaves"}) fs::rename(made + part, folder + part);
    fs::remove(made);
  } catch (const std::exception&) {
    fs::remove_all(made, none);
    if (is_new) fs::remove(folder, none);
    throw;
  }
}

KeyStore::KeyStore(const std::string& folder) : folder_(folder) {
  require_read_permission(private_file(kIdentityKey));
  std::error_code error;
  const bool exists = fs::exists(private_file(kIdentityKey), error);
  if (error)
    throw std::invalid_argument(
        fmt::format("cannot read the folder of keys {}: {}", folder_, error.message()));
  if (!exists)
    throw std::invalid_argument(
        fmt::format("expected a folder that `sidestep keys init` has made, but {} does not exist",
                    private_file(kIdentityKey)));
}

std::string KeyStore::issue(const Identity& identity, Time now, Time until) {
  const FolderLock lock(folder_);
  const Authority identities = identity_authority(folder_);
  const Authority permissions(public_file(key_files::kPermissionsAuthority), private_file(kPermissionsKey));
  // A key is not accepted after an authority has expired.
  until = std::min({until, identities.certificate().not_after(), permissions.certificate().not_after()});
  if (until <= now)
    throw std::invalid_argument(
        fmt::format("the authorities in {} expired on {}; make new keys in another folder", folder_,
                    date_text(authorities_expire())));
  const PrivateKey key = make_private_key();
  const Certificate certificate = identities.issue(identity, key, now, until);
  const std::string signed_permissions = permissions.sign(
      permissions_text(identity, certificate.subject(), now - kTimeZones, until + kTimeZones));
  if (signed_permissions.size() > kMaxPermissions)
    throw std::invalid_argument(fmt::format(
        "{}: too many robots for one key: its permissions take {} bytes, and a handshake has room for "
        "{}; issue several keys for fewer robots each",
        to_text(identity), signed_permissions.size(), kMaxPermissions));
  const std::string folder = folder_ + "/enclaves/" + folder_name(identity);
  create_folder(folder);
  fs::permissions(folder, fs::perms::owner_all);
  for (const char* name : {key_files::kIdentityAuthority, key_files::kPermissionsAuthority,
                           key_files::kRevoked, key_files::kGovernance})
    link_public_file(folder, name);
  FileChanges changes;
  changes.add(public_file(fmt::format("{}/{}.pem", key_files::kIssued, certificate.serial())),
              to_pem(certificate), kPublic);
  changes.add(folder + "/" + key_files::kPermissions, signed_permissions, kPublic);
  changes.add(folder + "/" + key_files::kPrivateKey, to_pem(key), kPrivate);
  changes.add(folder + "/" + key_files::kCertificate, to_pem(certificate), kPublic);
  changes.apply();
  return folder;
}

void KeyStore::write_revoked(const std::set<std::string>& serials, Time now) {
  const Authority authority = identity_authority(folder_);
  write_file(public_file(key_files::kRevoked),
             authority.revocation_list(serials, now, authority.certificate().not_after()));
  if (revoked_serials(folder_) != serials)
    throw std::runtime_error("the list of revoked keys in " + public_file(key_files::kRevoked) +
                             " differs from what was written; these keys may still be valid");
}

std::vector<Revocation> KeyStore::revoke(std::span<const Identity> identities, Time now) {
  const FolderLock lock(folder_);
  const std::set<std::string> known = revoked_serials(folder_);
  std::set<std::string> serials = known;
  const std::vector<IssuedKey> issued = keys();
  std::vector<Revocation> result;
  for (const Identity& identity : identities) {
    Revocation& done = result.emplace_back(Revocation{identity});
    for (const IssuedKey& key : issued) {
      if (key.name == to_text(identity)) ++(serials.insert(key.serial).second ? done.revoked : done.before);
    }
  }
  if (serials != known) write_revoked(serials, now);
  for (const Identity& identity : identities) fs::remove_all(folder_ + "/enclaves/" + folder_name(identity));
  return result;
}

std::vector<IssuedKey> KeyStore::keys() const {
  const std::set<std::string> serials = revoked_serials(folder_);
  std::vector<IssuedKey> result;
  for (const auto& entry : fs::directory_iterator(public_file(key_files::kIssued))) {
    if (entry.path().extension() != ".pem") continue;  // left by a process that was killed
    IssuedKey& key = result.emplace_back();
    key.serial = entry.path().stem().string();
    try {
      const Certificate certificate = Certificate::load(entry.path().string());
      const auto identity = certificate.identity();
      key.name = identity ? to_text(*identity) : certificate.subject();
      key.serial = certificate.serial();
      key.not_after = certificate.not_after();
    } catch (const std::exception& error) {
      key.problem = error.what();
    }
    key.is_revoked = serials.count(key.serial) > 0;
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
