// SPDX-License-Identifier: Apache-2.0
#include "common/keys/key_folder.hpp"

#include <filesystem>
#include <fmt/format.h>

#include "common/file/write_file.hpp"
#include "tests/catch.hpp"
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

TEST_CASE("keys are loaded as they were issued") {
  TestKeys keys({"agent", "3"});
  const KeyFolder folder = load_key_folder(keys.folder_of("agent 3"), keys.now());
  CHECK(folder.identity == Identity{Role::kAgent, 3, 3});
  CHECK(folder.certificate.is_issued_by(folder.authority));
  CHECK(fs::path(folder.path).is_absolute());
  for (const char* name : key_files::kAll) CHECK(fs::exists(folder.file(name)));
}

TEST_CASE("what is wrong with keys is said in plain words") {
  TestKeys keys({"agent", "3-4"}), others({"agent", "3"});
  const std::string folder = keys.folder_of("agent 3");
  const auto problem = [&] { return problem_of(folder, keys.now()); };
  CHECK(problem().empty());
  SECTION("expired") {
    CHECK_THAT(problem_of(folder, keys.now() + hours(2)),
               ContainsSubstring("the key of agent 3 expired on " + date_text(keys.now() + hours(1))));
  }
  SECTION("not valid yet") {
    CHECK_THAT(problem_of(folder, keys.now() - hours(1)), ContainsSubstring("is this host's clock right?"));
  }
  SECTION("revoked") {
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
  SECTION("others may read the private key") {
    fs::permissions(folder + "/key.pem", fs::perms::group_read, fs::perm_options::add);
    CHECK_THAT(problem(), ContainsSubstring("other users may read or change this private key; chmod 600"));
  }
  SECTION("the private key of another") {
    fs::copy_file(keys.folder_of("agent 4") + "/key.pem", folder + "/key.pem",
                  fs::copy_options::overwrite_existing);
    CHECK_THAT(problem(), ContainsSubstring("this private key is not that of the certificate"));
  }
  SECTION("another authority") {
    fs::copy_file(others.folder_of("agent 3") + "/cert.pem", folder + "/cert.pem",
                  fs::copy_options::overwrite_existing);
    CHECK_THAT(problem(), ContainsSubstring("cert.pem: another authority has issued it"));
  }
  SECTION("the certificate of an authority") {
    fs::copy_file(keys.folder() + "/public/identity_ca.cert.pem", folder + "/cert.pem",
                  fs::copy_options::overwrite_existing);
    CHECK_THAT(problem(), ContainsSubstring("expected the certificate of an identity"));
  }
  SECTION("no folder") {
    CHECK_THAT(problem_of(folder + "-none", keys.now()), ContainsSubstring("does not exist"));
  }
}

TEST_CASE("a process takes its own keys from a folder with those of several") {
  TestKeys keys({"agent", "3", "robot", "0-10", "vision"});
  const auto own = [&](const char* text) {
    return own_key_folder(keys.folder(), parse_identity(text).value());
  };
  CHECK(own("agent 3") == keys.folder() + "/enclaves/agent-3");
  CHECK(own("robot 4") == keys.folder() + "/enclaves/robot-0-10");
  CHECK(own("robot 2-7") == keys.folder() + "/enclaves/robot-0-10");
  CHECK_THROWS_WITH(own("robot 9-11"), ContainsSubstring("has no keys of robot 9-11"));
  CHECK_THROWS_WITH(own("agent 4"), ContainsSubstring("sidestep keys issue"));
  // Somebody who names the folder of one identity means that one.
  CHECK(own_key_folder(keys.folder_of("vision"), {Role::kViewer}) == keys.folder_of("vision"));
  CHECK_THROWS_WITH(key_folder_of(keys.folder_of("vision"), {Role::kVision}),
                    ContainsSubstring("sidestep keys init"));
}

}  // namespace sidestep::key_folder_test
