// SPDX-License-Identifier: Apache-2.0
#include "common/keys/key_folder.hpp"

#include <filesystem>
#include <fmt/format.h>

#include "common/file/write_file.hpp"
#include "deploy/run/keys/permissions_text.hpp"
#include "tests/as_nobody.hpp"
#include "tests/catch.hpp"
#include "tests/needs_root.hpp"
#include "tests/test_keys.hpp"

namespace sidestep::key_folder_test {

namespace fs = std::filesystem;
using std::chrono::hours;

std::string problem_of(const std::string& folder, Time now) {
  try {
    (void)load_key_folder(folder, now);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("loaded keys equal the issued keys") {
  TestKeys keys({"agent", "3"});
  const KeyFolder folder = load_key_folder(keys.folder_of("agent 3"), keys.now());
  CHECK(folder.identity == Identity{Role::kAgent, 3, 3});
  CHECK(folder.certificate.is_issued_by(folder.authority));
  CHECK(fs::path(folder.path).is_absolute());
  for (const char* name : key_files::kAll) CHECK(fs::exists(folder.file(name)));
}

TEST_CASE("an error about unusable keys states the problem in plain words") {
  TestKeys keys({"agent", "3-4"}), others({"agent", "3"});
  const std::string folder = keys.folder_of("agent 3");
  const auto problem = [&] { return problem_of(folder, keys.now()); };
  CHECK(problem().empty());
  SECTION("the certificate has expired") {
    CHECK_THAT(problem_of(folder, keys.now() + hours(2)),
               ContainsSubstring("the key of agent 3 expired on " + date_text(keys.now() + hours(1))));
  }
  SECTION("the key is revoked") {
    const TemporaryFolder copy;
    fs::copy(folder, copy.file("agent-3"));
    keys.revoke({Role::kAgent, 3, 3});
    fs::copy_file(keys.folder() + "/public/crl.pem", copy.file("agent-3/crl.pem"),
                  fs::copy_options::overwrite_existing);
    CHECK_THAT(problem_of(copy.file("agent-3"), keys.now()),
               ContainsSubstring("the key of agent 3 is revoked"));
  }
  SECTION("a file is missing") {
    for (const char* name : key_files::kAll) {
      CAPTURE(name);
      const TemporaryFolder copy;
      fs::copy(folder, copy.file("keys"));
      fs::remove(copy.file("keys/") + name);
      CHECK_THAT(problem_of(copy.file("keys"), keys.now()),
                 ContainsSubstring(std::string(name) + " does not exist"));
    }
  }
  SECTION("other users can read the private key") {
    fs::permissions(folder + "/key.pem", fs::perms::group_read, fs::perm_options::add);
    CHECK_THAT(problem(), ContainsSubstring("other users may read or change this private key; chmod 600"));
  }
  SECTION("the private key belongs to another process") {
    fs::copy_file(keys.folder_of("agent 4") + "/key.pem", folder + "/key.pem",
                  fs::copy_options::overwrite_existing);
    CHECK_THAT(problem(), ContainsSubstring("this private key does not match the certificate"));
  }
  SECTION("another authority issued the certificate") {
    fs::copy_file(others.folder_of("agent 3") + "/cert.pem", folder + "/cert.pem",
                  fs::copy_options::overwrite_existing);
    CHECK_THAT(problem(), ContainsSubstring("cert.pem: issued by an authority other than"));
  }
  SECTION("the certificate is the authority's own") {
    fs::copy_file(keys.folder() + "/public/identity_ca.cert.pem", folder + "/cert.pem",
                  fs::copy_options::overwrite_existing);
    CHECK_THAT(problem(), ContainsSubstring("expected the certificate of an identity"));
  }
  SECTION("the folder is missing") {
    CHECK_THAT(problem_of(folder + "-none", keys.now()), ContainsSubstring("does not exist"));
  }
}

/// Keys of agent 3 in which `text` replaces one file.
std::string with_file(const TestKeys& keys, const char* name, const std::string& text) {
  const std::string folder = keys.folder_of("agent 3");
  fs::remove(folder + "/" + name);  // may be a link to a file shared by all identities
  write_file(folder + "/" + name, text);
  return folder;
}

Authority authority_of(const TestKeys& keys, const std::string& name) {
  return Authority(keys.folder() + "/public/" + name + ".cert.pem",
                   keys.folder() + "/private/" + name + ".key.pem");
}

std::string permissions_of(const TestKeys& keys, Time from, Time until) {
  const Identity identity{Role::kAgent, 3, 3};
  return authority_of(keys, "permissions_ca")
      .sign(permissions_text(identity, "CN=agent 3,O=Sidestep", from, until));
}

TEST_CASE("keys that are not valid yet are not a usage error because the clock may still be set") {
  const TestKeys keys({"agent", "3"});
  const Time now = keys.now(), before = now - hours(1), later = now + hours(1);
  const auto check = [&](const std::string& folder, Time time, const std::string& what) {
    CHECK_THROWS_AS(load_key_folder(folder, time), std::runtime_error);
    CHECK_THROWS_WITH(load_key_folder(folder, time),
                      ContainsSubstring(what) && ContainsSubstring("is not valid before") &&
                          ContainsSubstring("this host's clock says " + date_text(time)));
  };
  SECTION("the key is not valid yet") {
    check(keys.folder_of("agent 3"), before, "cert.pem: the key of agent 3");
  }
  SECTION("the revocation list is not valid yet") {
    const std::string list = authority_of(keys, "identity_ca").revocation_list({}, later, later + hours(1));
    check(with_file(keys, key_files::kRevoked, list), now, "crl.pem: this list of revoked keys");
  }
  SECTION("the permissions are not valid yet") {
    const std::string permissions = permissions_of(keys, later, later + hours(1));
    check(with_file(keys, key_files::kPermissions, permissions), now,
          "permissions.p7s: the permissions of agent 3");
  }
  SECTION("the authorities are not valid yet") {
    const Authority identities("identity authority", later, later + hours(1));
    const auto key = make_private_key();
    with_file(keys, key_files::kIdentityAuthority, to_pem(identities.certificate()));
    with_file(keys, key_files::kRevoked, identities.revocation_list({}, now, later));
    with_file(keys, key_files::kCertificate, to_pem(identities.issue({Role::kAgent, 3, 3}, key, now, later)));
    const std::string file = with_file(keys, key_files::kPrivateKey, to_pem(key)) + "/key.pem";
    fs::permissions(file, fs::perms(0600));
    check(keys.folder_of("agent 3"), now, "identity_ca.cert.pem: this authority");
  }
}

TEST_CASE("keys that Fast DDS would reject without a reason get an error that names the problem") {
  const TestKeys keys({"agent", "3-4"}), others({"agent", "3"});
  const Time now = keys.now(), earlier = now - hours(2);
  SECTION("the revocation list has expired") {
    const std::string list = authority_of(keys, "identity_ca").revocation_list({}, earlier, now - hours(1));
    CHECK_THAT(problem_of(with_file(keys, key_files::kRevoked, list), now),
               ContainsSubstring("crl.pem: this list of revoked keys expired on"));
  }
  SECTION("the permissions have expired") {
    const std::string permissions = permissions_of(keys, earlier, now - hours(1));
    CHECK_THAT(problem_of(with_file(keys, key_files::kPermissions, permissions), now),
               ContainsSubstring("permissions.p7s: the permissions of agent 3 expired on"));
  }
  SECTION("the permissions belong to another process") {
    const std::string folder = keys.folder_of("agent 3");
    fs::copy_file(keys.folder_of("agent 4") + "/permissions.p7s", folder + "/permissions.p7s",
                  fs::copy_options::overwrite_existing);
    CHECK_THAT(problem_of(folder, now), ContainsSubstring("expected the permissions of agent 3"));
  }
  SECTION("another authority signed the documents") {
    const char* const name = GENERATE(key_files::kPermissions, key_files::kGovernance);
    const std::string folder = keys.folder_of("agent 3");
    fs::remove(folder + "/" + name);
    fs::copy_file(others.folder_of("agent 3") + "/" + name, folder + "/" + name);
    CHECK_THAT(problem_of(folder, now),
               ContainsSubstring(std::string(name) + ": the permissions authority beside it has not signed"));
  }
  SECTION("the documents are not signed") {
    CHECK_THAT(problem_of(with_file(keys, key_files::kPermissions, "nonsense"), now),
               ContainsSubstring("permissions.p7s: expected a signed document"));
  }
}

TEST_CASE("a user without read permission gets an error that names the file, the user and the owner") {
  SIDESTEP_NEEDS_ROOT();
  const TestKeys keys({"agent", "3"});
  const std::string folder = keys.folder_of("agent 3");
  const auto open = [](const std::string& path) { fs::permissions(path, fs::perms(0755)); };
  open(fs::path(keys.folder()).parent_path());
  const auto problem = [&](const std::string& path) {
    return as_nobody([&] {
      try {
        return problem_of(own_key_folder(path, {Role::kAgent, 3, 3}), keys.now());
      } catch (const std::invalid_argument& error) {
        return std::string(error.what());
      }
    });
  };
  const std::string enclaves = keys.folder() + "/enclaves";
  CHECK(problem(keys.folder()) ==
        "user nobody may not read " + enclaves + ": " + enclaves + " belongs to root and has mode 0700");
  open(enclaves);
  CHECK(problem(keys.folder()) ==
        "user nobody may not read " + folder + ": " + folder + " belongs to root and has mode 0700");
  open(folder);
  const std::string key = folder + "/key.pem";
  CHECK(problem(keys.folder()) ==
        "user nobody may not read " + key + ": " + key + " belongs to root and has mode 0600");
  CHECK(problem(folder) == problem(keys.folder()));
}

TEST_CASE("a process picks its own keys from a folder that holds keys of several processes") {
  TestKeys keys({"agent", "3", "robot", "0-10", "vision"});
  const auto own = [&](const char* text) {
    return own_key_folder(keys.folder(), parse_identity(text).value());
  };
  CHECK(own("agent 3") == keys.folder() + "/enclaves/agent-3");
  CHECK(own("robot 4") == keys.folder() + "/enclaves/robot-0-10");
  CHECK(own("robot 2-7") == keys.folder() + "/enclaves/robot-0-10");
  CHECK_THROWS_WITH(own("robot 9-11"), ContainsSubstring("has no keys of robot 9-11"));
  CHECK_THROWS_WITH(
      own("client bob"),
      EndsWith(fmt::format("`sidestep keys issue client bob --keys {}` makes them", keys.folder())));
  CHECK_THROWS_WITH(own("agent 4"), ContainsSubstring("sidestep keys issue"));
  // A path to the folder of one identity selects that identity.
  CHECK(own_key_folder(keys.folder_of("vision"), {Role::kViewer}) == keys.folder_of("vision"));
  CHECK_THROWS_WITH(key_folder_of(keys.folder_of("vision"), {Role::kVision}),
                    ContainsSubstring("sidestep keys init"));
}

TEST_CASE("a process whose keys were revoked is told so, until it gets new ones") {
  TestKeys keys({"client", "alice", "agent", "3", "robot", "0-10"});
  const auto own = [&](const char* text) {
    return own_key_folder(keys.folder(), parse_identity(text).value());
  };
  for (const char* name : {"client alice", "agent 3"}) {
    CAPTURE(name);
    const Identity identity = parse_identity(name).value();
    REQUIRE(keys.revoke(identity) == 1);
    CHECK_THROWS_WITH(
        own(name),
        fmt::format("--keys: the keys of {} were revoked; `sidestep keys show --keys {}` lists all keys",
                    name, keys.folder()));
    keys.issue(identity);
    CHECK(own(name) == keys.folder() + "/enclaves/" + folder_name(identity));
  }
  CHECK_THROWS_WITH(own("client bob"), ContainsSubstring("has no keys of client bob"));
  REQUIRE(keys.revoke({Role::kRobot, 0, 10}) == 1);
  CHECK_THROWS_WITH(own("robot 4"), ContainsSubstring("the keys of robot 4 were revoked"));
  CHECK_THROWS_WITH(own("robot 9-11"), ContainsSubstring("has no keys of robot 9-11"));
}

}  // namespace sidestep::key_folder_test
