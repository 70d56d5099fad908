// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/keys/key_store.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <iterator>
#include <map>
#include <sstream>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "common/file/write_file.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/needs_root.hpp"
#include "tests/small_disk.hpp"
#include "tests/test_keys.hpp"
#include "tests/text_of.hpp"

namespace sidestep::key_store_test {

namespace fs = std::filesystem;
using std::chrono::hours;

TEST_CASE("private keys are readable only by their owner") {
  const TestKeys keys({"agent", "3", "judge"});
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(keys.folder())) {
    if (!entry.path().string().ends_with("key.pem")) continue;
    CAPTURE(entry.path());
    CHECK(fs::status(entry.path()).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
    ++count;
  }
  CHECK(count == 4);  // keys of both authorities and both identities
  CHECK(fs::status(keys.folder() + "/private").permissions() == fs::perms::owner_all);
}

TEST_CASE("the authorities for identities and permissions have different keys") {
  const TestKeys keys({});
  const auto load = [&](const char* name) { return Certificate::load(keys.folder() + "/public/" + name); };
  const Certificate identities = load(key_files::kIdentityAuthority),
                    permissions = load(key_files::kPermissionsAuthority);
  CHECK(identities.subject() != permissions.subject());
  CHECK_FALSE(permissions.is_issued_by(identities));
  CHECK_FALSE(identities.is_issued_by(permissions));
}

TEST_CASE("new authorities never overwrite keys") {
  const TestKeys keys({});
  CHECK_THROWS_WITH(KeyStore::create(keys.folder(), keys.now(), keys.now() + hours(1)),
                    ContainsSubstring("keys are never overwritten"));
  CHECK_THROWS_WITH(KeyStore(keys.folder() + "/public"), ContainsSubstring("sidestep keys init"));
}

TEST_CASE("a new key replaces the former key, which stays valid until it is revoked") {
  TestKeys keys({"agent", "3"});
  const std::string first = Certificate::load(keys.folder_of("agent 3") + "/cert.pem").serial();
  keys.issue({Role::kAgent, 3, 3});
  const std::string second = Certificate::load(keys.folder_of("agent 3") + "/cert.pem").serial();
  CHECK(first != second);
  REQUIRE(keys.store().keys().size() == 2);
  for (const IssuedKey& key : keys.store().keys()) {
    CHECK(key.name == "agent 3");
    CHECK_FALSE(key.is_revoked);
  }
  CHECK(keys.revoke({Role::kAgent, 3, 3}) == 2);
  for (const IssuedKey& key : keys.store().keys()) CHECK(key.is_revoked);
  CHECK_FALSE(keys.store().has({Role::kAgent, 3, 3}));
  CHECK(keys.revoke({Role::kAgent, 3, 3}) == 0);
  // A key that is issued afterwards is valid.
  keys.issue({Role::kAgent, 3, 3});
  CHECK(load_key_folder(keys.folder_of("agent 3"), keys.now()).identity.first == 3);
}

TEST_CASE("revoking one identity does not affect the others") {
  TestKeys keys({"agent", "3-4", "vision"});
  keys.revoke({Role::kAgent, 4, 4});
  CHECK_NOTHROW(load_key_folder(keys.folder_of("agent 3"), keys.now()));
  CHECK_NOTHROW(load_key_folder(keys.folder_of("vision"), keys.now()));
  CHECK_THROWS(keys.folder_of("agent 4"));
}

TEST_CASE("the list of revoked keys is written again only if it gets longer") {
  TestKeys keys({"agent", "3-4"});
  const std::string list = keys.folder() + "/public/crl.pem";
  const std::string empty = text_of(list);
  CHECK(keys.revoke({Role::kClient, 0, 0, "zed"}) == 0);
  CHECK(text_of(list) == empty);
  CHECK(keys.revoke({Role::kAgent, 3, 3}) == 1);
  const std::string revoked = text_of(list);
  CHECK(revoked != empty);
  CHECK(keys.revoke({Role::kAgent, 3, 3}) == 0);
  CHECK(text_of(list) == revoked);
}

TEST_CASE("several identities are revoked together even if some of them are already revoked") {
  TestKeys keys({"agent", "0-3"});
  const std::vector<Identity> all{
      {Role::kAgent, 0, 0}, {Role::kAgent, 2, 2}, {Role::kAgent, 3, 3}, {Role::kVision}};
  CHECK(keys.revoke(all[1]) == 1);
  // A file that a killed process has left, and a file that is not a certificate.
  write_file(keys.folder() + "/public/issued/ab.pem.4711.tmp", "half");
  write_file(keys.folder() + "/public/issued/77.pem", "none");
  const auto done = keys.store().revoke(all, keys.now());
  REQUIRE(done.size() == 4);
  const std::vector<std::pair<std::size_t, std::size_t>> expected{{1, 0}, {0, 1}, {1, 0}, {0, 0}};
  for (std::size_t i = 0; i < done.size(); ++i) {
    CHECK(to_text(done[i].identity) == to_text(all[i]));
    CHECK(std::pair(done[i].revoked, done[i].before) == expected[i]);
  }
  std::vector<std::string> valid, unreadable;
  for (const IssuedKey& key : keys.store().keys()) {
    if (!key.problem.empty())
      unreadable.push_back(key.serial);
    else if (!key.is_revoked)
      valid.push_back(key.name);
  }
  CHECK(valid == std::vector<std::string>{"agent 1"});
  CHECK(unreadable == std::vector<std::string>{"77"});
}

/// Performs random operations on a key folder that several processes change concurrently. Writes the serial
/// numbers of keys that it has revoked to a pipe.
void act_at_random(const std::string& folder, Time now, Rng& rng, int report) {
  KeyStore store(folder);
  const auto number = static_cast<RobotId>(rng.below(4));
  const Identity identity{Role::kAgent, number, number};
  switch (rng.below(3)) {
    case 0:
      (void)store.issue(identity, now, now + hours(1));
      return;
    case 1: {
      std::set<std::string> before;
      for (const IssuedKey& key : store.keys()) {
        if (key.name == to_text(identity)) before.insert(key.serial);
      }
      (void)store.revoke(std::span(&identity, 1), now);
      for (const std::string& serial : before) {
        const std::string line = serial + "\n";
        (void)!write(report, line.data(), line.size());
      }
      return;
    }
    default:
      (void)store.keys();
  }
}

/// Processes issue, revoke and list keys concurrently and are killed at random. Keys reported as revoked must
/// stay revoked, and the folder must always be readable.
void interleave(int rounds, std::uint64_t seed) {
  constexpr int kAtOnce = 3;
  CAPTURE(seed);
  Rng rng(seed);
  auto keys = std::make_unique<TestKeys>(std::vector<std::string>{"agent", "0-3"});
  std::set<std::string> revoked;
  std::size_t reported = 0;
  int killed = 0;
  for (int round = 0; round < rounds; ++round) {
    CAPTURE(round);
    // Reading a list of several hundred keys takes long.
    if (round % 50 == 49) {
      keys = std::make_unique<TestKeys>(std::vector<std::string>{"agent", "0-3"});
      revoked.clear();
    }
    std::array<int, 2> report{};
    REQUIRE(pipe2(report.data(), O_CLOEXEC) == 0);
    std::array<pid_t, kAtOnce> processes{};
    for (pid_t& process : processes) {
      Rng own(rng.bits());
      process = fork();
      if (process != 0) continue;
      int code = 1;
      try {
        act_at_random(keys->folder(), keys->now(), own, report[1]);
        code = 0;
      } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
      }
      std::_Exit(code);
    }
    close(report[1]);
    const bool is_killed = rng.below(2) == 0;
    if (is_killed) {
      std::this_thread::sleep_for(std::chrono::microseconds(rng.below(4000)));
      kill(processes[rng.below(kAtOnce)], SIGKILL);
    }
    for (const pid_t process : processes) {
      int status = 0;
      REQUIRE(waitpid(process, &status, 0) == process);
      if (WIFSIGNALED(status)) ++killed;
      CHECK((WIFSIGNALED(status) || WEXITSTATUS(status) == 0));
    }
    std::string text;
    std::array<char, 4096> buffer{};
    for (ssize_t got = 0; (got = read(report[0], buffer.data(), buffer.size())) > 0;)
      text.append(buffer.data(), static_cast<std::size_t>(got));
    close(report[0]);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) reported += revoked.insert(line).second;
    std::set<std::string> listed;
    for (const IssuedKey& key : keys->store().keys()) {
      CHECK(key.problem.empty());
      if (key.is_revoked) listed.insert(key.serial);
    }
    CHECK(std::ranges::includes(listed, revoked));
  }
  CHECK(reported > static_cast<std::size_t>(rounds) / 10);
  CHECK(killed > rounds / 10);
}

TEST_CASE("a key reported as revoked stays revoked while other processes change the folder and are killed") {
  interleave(200, 71);
}

TEST_CASE("a key reported as revoked stays revoked for ten thousand rounds", "[.long][slow]") {
  interleave(10'000, 72);
}

TEST_CASE("a key for more robots than a handshake can carry is rejected, and nothing is written") {
  TestKeys keys({});
  keys.issue({Role::kRobot, 0, 399});
  CHECK_THROWS_WITH(keys.issue({Role::kRobot, 0, 1023}), ContainsSubstring("too many robots for one key"));
  CHECK_FALSE(fs::exists(keys.folder() + "/enclaves/robot-0-1023"));
}

/// All files of a folder with their contents, and all links with their targets.
std::map<std::string, std::string> contents(const std::string& folder) {
  std::map<std::string, std::string> result;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_symlink())
      result[entry.path().string()] = fs::read_symlink(entry.path()).string();
    else if (entry.is_regular_file())
      result[entry.path().string()] = text_of(entry.path());
  }
  return result;
}

TEST_CASE("keys on a full disk stay as they are, and the cause is named") {
  SIDESTEP_NEEDS_ROOT();
  const Time now = EventLoop::now();
  const SmallDisk disk(256);
  const std::string folder = disk.file("keys");
  const Identity agent{Role::kAgent, 3, 3};
  KeyStore::create(folder, now, now + hours(24));
  KeyStore store(folder);
  (void)store.issue(agent, now, now + hours(1));
  disk.fill();
  const auto before = contents(folder);
  CHECK_THROWS_WITH(store.issue(agent, now, now + hours(1)),
                    StartsWith("cannot write ") && EndsWith("No space left on device"));
  CHECK_THROWS_WITH(store.revoke(std::span(&agent, 1), now),
                    StartsWith("cannot write ") && EndsWith("No space left on device"));
  CHECK(contents(folder) == before);
}

TEST_CASE("new authorities that do not fit on the disk leave nothing behind") {
  SIDESTEP_NEEDS_ROOT();
  const Time now = EventLoop::now();
  const SmallDisk disk(256);
  disk.fill();
  const std::string folder = disk.file("keys");
  CHECK_THROWS_WITH(KeyStore::create(folder, now, now + hours(24)),
                    StartsWith("cannot write ") && EndsWith("No space left on device"));
  CHECK_FALSE(fs::exists(folder));
  fs::remove(disk.file("filling"));
  KeyStore::create(folder, now, now + hours(24));
  CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 3);
}

TEST_CASE("the error about a read-only folder of keys names the folder") {
  SIDESTEP_NEEDS_ROOT();
  const Time now = EventLoop::now();
  const SmallDisk disk;
  disk.make_read_only();
  CHECK_THROWS_WITH(KeyStore::create(disk.file("keys"), now, now + hours(24)),
                    "cannot create the folder " + disk.file("keys") + ": Read-only file system");
}

TEST_CASE("no key outlives its authorities") {
  TestKeys keys({});
  const std::string folder = keys.issue({Role::kVision}, hours(1000));
  CHECK(Certificate::load(folder + "/cert.pem").not_after() == keys.store().authorities_expire());
  CHECK_THROWS_WITH(keys.store().issue({Role::kJudge}, keys.now() + hours(1000), keys.now() + hours(1001)),
                    ContainsSubstring("the authorities in") && ContainsSubstring("expired on"));
}

}  // namespace sidestep::key_store_test
