// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/keys/keys_command.hpp"

#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "common/keys/key_folder.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/process/command_line.hpp"
#include "tests/as_nobody.hpp"
#include "tests/capture_output.hpp"
#include "tests/catch.hpp"
#include "tests/needs_root.hpp"

namespace sidestep::keys_command_test {

namespace fs = std::filesystem;

/// Runs `sidestep` with these arguments. Returns the error, or an empty string.
std::string run(const std::vector<std::string>& arguments) {
  CommandLine command_line("test", "sidestep");
  std::function<int()> action;
  add_keys_command(command_line.root(), action);
  try {
    command_line.parse(arguments);
    return action && action() == 0 ? "" : "no action";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST_CASE("keys are made, replaced, revoked and shown") {
  const TemporaryFolder temporary;
  const std::string keys = temporary.file("keys"), agent = keys + "/enclaves/agent-3";
  REQUIRE(run({"keys", "init", keys}).empty());
  CHECK(run({"keys", "issue", "agent", "3", "vision", "--keys", keys}).empty());
  CHECK(fs::exists(agent + "/cert.pem"));
  CHECK_THAT(run({"keys", "issue", "agent", "3", "--keys", keys}),
             ContainsSubstring("agent 3 already has a key; --again"));
  const std::string first = Certificate::load(agent + "/cert.pem").serial();
  CHECK(run({"keys", "issue", "agent", "3", "--again", "--days", "2", "--keys", keys}).empty());
  CHECK(Certificate::load(agent + "/cert.pem").serial() != first);
  const Certificate second = Certificate::load(agent + "/cert.pem");
  // Hosts whose clocks are slightly behind accept the key.
  CHECK(second.not_after() - second.not_before() == std::chrono::hours(48) + std::chrono::minutes(10));
  CHECK(run({"keys", "show", "--keys", keys}).empty());
  CHECK(run({"keys", "revoke", "agent", "3", "--keys", keys}).empty());
  CHECK_FALSE(fs::exists(agent));
  CHECK(run({"keys", "revoke", "agent", "3", "--keys", keys}).empty());
  CHECK_THAT(run({"keys", "revoke", "agent", "3-4", "vision", "--keys", keys}),
             ContainsSubstring("no key was issued for agent 4"));
  CHECK_FALSE(fs::exists(keys + "/enclaves/vision"));
}

TEST_CASE("revoke says how many keys it has revoked, and what other hosts need") {
  const TemporaryFolder temporary;
  const std::string keys = temporary.file("keys");
  const std::string what_next = "processes that use " + keys +
                                "/enclaves refuse them within a second; copy " + keys +
                                "/public/crl.pem into the folders of keys on other hosts\n";
  REQUIRE(run({"keys", "init", keys}).empty());
  REQUIRE(run({"keys", "issue", "agent", "3", "vision", "--keys", keys}).empty());
  REQUIRE(run({"keys", "issue", "agent", "3", "--again", "--keys", keys}).empty());
  std::string text, error;
  const auto revoke = [&](std::vector<std::string> identities) {
    identities.insert(identities.begin(), {"keys", "revoke", "--keys", keys});
    CaptureStdout output;
    error = run(identities);
    text = output.finish();
  };
  revoke({"agent", "3"});
  CHECK(error.empty());
  CHECK(text == "revoked 2 keys of agent 3\n" + what_next);
  revoke({"agent", "3-4", "vision"});
  CHECK(error == "no key was issued for agent 4; `sidestep keys show` lists all");
  CHECK(text == "agent 3: already revoked\nrevoked 1 key of vision\n" + what_next);
  revoke({"operator"});
  CHECK(error == "no key was issued for operator; `sidestep keys show` lists all");
  CHECK(text.empty());
}

TEST_CASE("all keys of a scenario are made with one command, and existing keys stay") {
  const TemporaryFolder temporary;
  const std::string keys = temporary.file("keys");
  const std::string scenario = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";
  const std::vector<std::string> issue{"keys", "issue", "--scenario", scenario, "--keys", keys};
  REQUIRE(run({"keys", "init", keys}).empty());
  CHECK(run(issue).empty());
  const std::string first = Certificate::load(keys + "/enclaves/agent-3/cert.pem").serial();
  CHECK(run(issue).empty());
  CHECK(Certificate::load(keys + "/enclaves/agent-3/cert.pem").serial() == first);
}

TEST_CASE("an error about wrong usage states the mistake") {
  const TemporaryFolder temporary;
  const std::string keys = temporary.file("keys");
  CHECK_THAT(run({"keys", "issue", "vision", "--keys", keys}),
             ContainsSubstring("expected a folder that `sidestep keys init` has made"));
  REQUIRE(run({"keys", "init", keys}).empty());
  CHECK_THAT(run({"keys", "init", keys}), ContainsSubstring("never overwritten"));
  CHECK_THAT(run({"keys", "issue", "--keys", keys}), ContainsSubstring("--scenario FILE, or identities"));
  CHECK_THAT(run({"keys", "issue", "robots", "--keys", keys}), ContainsSubstring("got 'robots'"));
  CHECK_THAT(run({"keys", "revoke", "--keys", keys}), ContainsSubstring("expected identities"));
  for (const char* days : {"-1", "0", "nan"})
    CHECK_THAT(run({"keys", "issue", "vision", "--days", days, "--keys", keys}), ContainsSubstring("--days"));
  CHECK_THAT(run({"keys", "init", temporary.file("other"), "--days", "0"}),
             ContainsSubstring("--days: expected a number from 1 to 36500"));
  CHECK_FALSE(fs::exists(temporary.file("other")));
  CHECK_FALSE(run({"keys"}).empty());
}

TEST_CASE("new keys and revocations are valid even on hosts whose clocks are ten minutes behind") {
  const TemporaryFolder temporary;
  const std::string keys = temporary.file("keys"), agent = keys + "/enclaves/agent-3";
  const Time behind = DdsBus::clock() - std::chrono::minutes(9);
  REQUIRE(run({"keys", "init", keys}).empty());
  REQUIRE(run({"keys", "issue", "agent", "3-4", "--keys", keys}).empty());
  REQUIRE(run({"keys", "revoke", "agent", "4", "--keys", keys}).empty());
  CHECK_NOTHROW(load_key_folder(agent, behind));
}

TEST_CASE("a user without read permission for the authorities' keys gets an error that states this") {
  SIDESTEP_NEEDS_ROOT();
  const TemporaryFolder temporary;
  const std::string keys = temporary.file("keys"), closed = keys + "/private";
  REQUIRE(run({"keys", "init", keys}).empty());
  fs::permissions(temporary.path(), fs::perms(0755));
  CHECK(as_nobody([&] {
          return run({"keys", "issue", "vision", "--keys", keys});
        }) == "user nobody may not read " + closed + "/identity_ca.key.pem: " + closed +
                  " belongs to root and has mode 0700");
}

}  // namespace sidestep::keys_command_test
