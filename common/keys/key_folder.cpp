// SPDX-License-Identifier: Apache-2.0
#include "common/keys/key_folder.hpp"

#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <openssl/x509.h>
#include <stdexcept>

#include "common/file/permission.hpp"
#include "common/keys/private_key.hpp"
#include "common/keys/signed_document.hpp"

namespace sidestep {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReissueHint = "`sidestep keys issue` makes a new one";

void require_files(const std::string& path) {
  std::error_code none;
  for (const char* name : key_files::kAll) {
    const std::string file = path + "/" + name;
    require_read_permission(file);
    if (fs::is_regular_file(file, none)) continue;
    throw std::invalid_argument(
        fmt::format("--keys: expected a folder that `sidestep keys issue` has written, but {} {}", file,
                    fs::exists(file, none) ? "is not a regular file" : "does not exist"));
  }
}

void require_own_private_key(const std::string& file, const Certificate& certificate) {
  constexpr auto kOthers = fs::perms::group_all | fs::perms::others_all;
  if ((fs::status(file).permissions() & kOthers) != fs::perms::none)
    throw std::invalid_argument(
        fmt::format("{}: other users may read or change this private key; chmod 600 {}", file, file));
  if (X509_check_private_key(certificate.x509(), load_private_key(file).get()) != 1)
    throw std::invalid_argument(file + ": this private key does not match the certificate beside it");
}

/// The clock may not have been set yet, so a key that is not valid yet is not a usage error: if the process
/// is restarted, it tries again.
void require_valid(const std::string& what, const ValidityPeriod& validity, Time now,
                   const char* remedy = "make new keys in another folder") {
  if (now > validity.until)
    throw std::invalid_argument(fmt::format("{} expired on {}; {}", what, date_text(validity.until), remedy));
  if (now < validity.from)
    throw std::runtime_error(
        fmt::format("{} is not valid before {}, but this host's clock says {}; is the clock right?", what,
                    date_text(validity.from), date_text(now)));
}

/// Checks the authority, the list of revoked keys and the permissions, because Fast DDS would refuse them
/// without saying why.
void require_valid_documents(const KeyFolder& keys, const RevocationList& revoked, Time now) {
  const auto what = [&](const char* file, const std::string& text) { return keys.file(file) + ": " + text; };
  require_valid(what(key_files::kIdentityAuthority, "this authority"), keys.authority.validity(), now);
  require_valid(what(key_files::kRevoked, "this list of revoked keys"), revoked.validity, now);
  const Certificate authority = Certificate::load(keys.file(key_files::kPermissionsAuthority));
  require_valid(what(key_files::kPermissionsAuthority, "this authority"), authority.validity(), now);
  (void)load_signed_document(keys.file(key_files::kGovernance), authority);
  const std::string permissions = load_signed_document(keys.file(key_files::kPermissions), authority);
  const auto validity = permissions_validity(permissions, keys.certificate.subject());
  if (!validity)
    throw std::invalid_argument(
        what(key_files::kPermissions, "expected the permissions of " + to_text(keys.identity)));
  require_valid(what(key_files::kPermissions, "the permissions of " + to_text(keys.identity)), *validity, now,
                kReissueHint);
}

/// Whether the folder made by `sidestep keys init` says that keys of this identity were revoked. Copies of
/// such a folder on other hosts may not say it.
bool were_revoked(const std::string& store, const Identity& identity) {
  const std::string in_public = store + "/public/";
  std::error_code none;
  try {
    const Certificate authority = Certificate::load(in_public + key_files::kIdentityAuthority);
    for (const std::string& serial : load_revoked_serials(in_public + key_files::kRevoked, authority)) {
      const std::string file = fmt::format("{}{}/{}.pem", in_public, key_files::kIssued, serial);
      if (!fs::is_regular_file(file, none)) continue;
      const auto other = Certificate::load(file).identity();
      if (other && other->role == identity.role && other->name == identity.name &&
          other->covers(identity.first) && other->covers(identity.last))
        return true;
    }
  } catch (const std::exception&) {
    // What is wrong with the store matters less than the keys that are missing.
  }
  return false;
}

}  // namespace

std::string utc_text(Time time, const char* format) {
  const std::time_t seconds =
      std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count();
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[64];
  return {text, std::strftime(text, sizeof text, format, &parts)};
}

std::string date_text(Time time) { return utc_text(time, "%Y-%m-%d %H:%M UTC"); }

std::string key_folder_of(const std::string& store, const Identity& identity) {
  std::error_code none;
  const std::string enclaves = store + "/enclaves";
  require_read_permission(enclaves);
  if (!fs::is_directory(enclaves, none))
    throw std::invalid_argument(fmt::format(
        "--keys: expected a folder that `sidestep keys init` has made, but {} does not exist", enclaves));
  const std::string exact = enclaves + "/" + folder_name(identity);
  require_read_permission(exact);
  if (fs::is_directory(exact, none)) return exact;
  for (const auto& entry : fs::directory_iterator(enclaves, none)) {
    std::string name = entry.path().filename().string();
    if (identity.role != Role::kRobot || !name.starts_with("robot-")) continue;
    const auto other = parse_identity(name.replace(5, 1, " "));
    if (other && other->first <= identity.first && other->last >= identity.last) return entry.path().string();
  }
  if (were_revoked(store, identity))
    throw std::invalid_argument(
        fmt::format("--keys: the keys of {} were revoked; `sidestep keys show --keys {}` lists all keys",
                    to_text(identity), store));
  // A scenario does not name the clients of its runs.
  const std::string remedy =
      identity.role == Role::kClient
          ? fmt::format("`sidestep keys issue {} --keys {}` makes them", to_text(identity), store)
          : fmt::format("`sidestep keys issue --scenario FILE --keys {}` makes all keys that a run needs",
                        store);
  throw std::invalid_argument(
      fmt::format("--keys: {} has no keys of {}; {}", enclaves, to_text(identity), remedy));
}

std::string own_key_folder(const std::string& path, const Identity& identity) {
  std::error_code none;
  require_read_permission(path);
  return fs::is_directory(path + "/enclaves", none) ? key_folder_of(path, identity) : path;
}

KeyFolder load_key_folder(const std::string& path, Time now) {
  require_files(path);
  const auto file = [&](const char* name) {
    return fs::absolute(path).lexically_normal().string() + "/" + name;
  };
  const Certificate certificate = Certificate::load(file(key_files::kCertificate));
  const Certificate authority = Certificate::load(file(key_files::kIdentityAuthority));
  const auto identity = certificate.identity();
  const std::string where = file(key_files::kCertificate);
  if (!identity)
    throw std::invalid_argument(fmt::format("{}: expected the certificate of an identity, got that of '{}'",
                                            where, certificate.subject()));
  if (!certificate.is_issued_by(authority))
    throw std::invalid_argument(
        fmt::format("{}: issued by an authority other than {}", where, file(key_files::kIdentityAuthority)));
  require_valid(fmt::format("{}: the key of {}", where, to_text(*identity)), certificate.validity(), now,
                kReissueHint);
  const KeyFolder keys{fs::absolute(path).lexically_normal().string(), *identity, certificate, authority};
  const RevocationList revoked = load_revocation_list(file(key_files::kRevoked), authority);
  if (revoked.serials.contains(certificate.serial()))
    throw std::invalid_argument(fmt::format("{}: the key of {} is revoked", where, to_text(*identity)));
  require_own_private_key(file(key_files::kPrivateKey), certificate);
  require_valid_documents(keys, revoked, now);
  return keys;
}

void require_domain(const KeyFolder& keys, int domain) {
  const Certificate authority = Certificate::load(keys.file(key_files::kPermissionsAuthority));
  for (const char* name : {key_files::kGovernance, key_files::kPermissions}) {
    if (!covers_domain(load_signed_document(keys.file(name), authority), domain))
      throw std::invalid_argument(
          fmt::format("{}: these keys do not cover DDS domain {}; make new keys in another folder",
                      keys.file(name), domain));
  }
}

}  // namespace sidestep
