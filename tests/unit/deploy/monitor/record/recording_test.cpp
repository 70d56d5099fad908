// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/record/recording.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/cdr.hpp"
#include "common/random/rng.hpp"
#include "deploy/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::recording_test {

using namespace std::chrono_literals;

const std::string kScenario = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";

/// A file that is removed at the end of the test.
struct TemporaryFile {
  std::string path =
      (std::filesystem::temp_directory_path() / ("recording_test_" + std::to_string(::getpid()))).string();
  ~TemporaryFile() { std::filesystem::remove(path); }
};

std::vector<char> contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const std::string& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Records the crossing for this long; returns the findings of the live auditor. `prepare` may change the
/// system before it runs.
AuditTotals record_run(
    const std::string& path, Duration duration,
    const std::function<void(SimSystem&)>& prepare = [](SimSystem&) {}) {
  const Scenario scenario = load_scenario(kScenario);
  RecordingHeader header = recording_header(scenario.name, kScenario);
  header.is_complete = true;
  RecordingWriter writer(path, header);
  SimSystem system(scenario, 3);
  SimBus bus(system.network());
  bus.become_observer();
  record(bus, scenario, writer);
  prepare(system);
  system.run_for(duration);
  writer.close();
  return system.auditor().totals();
}

struct AuditedPlayback {
  AuditTotals audit;
  PlaybackResult result;
};

AuditedPlayback play(const std::string& path) {
  PlaybackBus bus(path);
  const Scenario scenario = parse_scenario(bus.header().scenario_text, "crossing.yaml");
  Auditor auditor(scenario, {bus.header().is_complete, {}});
  refuse_other_rules(bus, scenario, auditor);
  listen(bus, scenario, auditor);
  const PlaybackResult result = bus.play();
  return {auditor.totals(), result};
}

TEST_CASE("a recording plays back the messages of the run") {
  const TemporaryFile file;
  const AuditTotals live = record_run(file.path, 2s);
  const AuditedPlayback again = play(file.path);
  CHECK(again.result.damage == "");
  CHECK(again.result.unreadable == 0);
  CHECK(again.result.messages > live.received);  // detection frames and agent status, too
  CHECK(again.audit.compared_pairs == live.compared_pairs);
  CHECK(again.audit.violations == 0);
  CHECK(again.audit.refused == 0);
  CHECK(again.audit.verdict() == AuditVerdict::kPassed);
  // Messages sent during the construction of the system are not recorded.
  CHECK(again.audit.received <= live.received);
  CHECK(again.audit.received + 20 > live.received);
}

TEST_CASE("the audit of a recording refuses messages of processes with other rules, and counts them") {
  const TemporaryFile file;
  record_run(file.path, 500ms, [](SimSystem& system) {
    Scenario changed = load_scenario(kScenario);
    changed.margin_m = 0.05;
    system.use_scenario(twin_process(3), changed);
    system.restart(twin_process(3));
  });
  const AuditedPlayback played = play(file.path);
  CHECK(played.audit.refused > 10);
  CHECK(played.audit.violations == 0);
}

/// The ends of all blocks. A file is 8 bytes of magic, then blocks of a size, a checksum and `size` bytes.
std::set<std::size_t> block_ends(const std::vector<char>& whole) {
  std::set<std::size_t> ends;
  for (std::size_t at = 8; at + 8 <= whole.size();) {
    std::uint32_t size = 0;
    std::memcpy(&size, whole.data() + at, sizeof size);
    at += 8 + size;
    ends.insert(at);
  }
  return ends;
}

TEST_CASE("a truncated recording is played up to its last whole block, and the truncation is reported") {
  const TemporaryFile file;
  record_run(file.path, 1s);
  const auto whole = contents(file.path);
  const auto ends = block_ends(whole);
  REQUIRE(ends.contains(whole.size()));
  std::uint64_t before = 0;
  const std::size_t header = 8 + 8 + 2000;  // magic, frame, and more than the size of the scenario file
  for (std::size_t size = whole.size() / 10 + header; size < whole.size(); size += whole.size() / 10 + 1) {
    CAPTURE(size);
    write(file.path, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    const AuditedPlayback played = play(file.path);
    CHECK(played.result.messages > before);
    CHECK(played.result.damage == (ends.contains(size) ? "" : "the file ends in the middle of a block"));
    CHECK(played.audit.violations == 0);
    before = played.result.messages;
  }
}

TEST_CASE("playing a corrupted recording ends without harm") {
  const TemporaryFile file;
  record_run(file.path, 300ms);
  const auto whole = contents(file.path);
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    auto broken = whole;
    const std::size_t from = seed % 3 == 0 ? 0 : 8;
    for (std::uint64_t i = 0; i <= rng.below(8); ++i)
      broken[from + rng.below(broken.size() - from)] = static_cast<char>(rng.bits());
    write(file.path, broken);
    try {
      const PlaybackResult result = PlaybackBus(file.path).play();
      CHECK((broken == whole || !result.damage.empty()));
    } catch (const std::runtime_error&) {
      SUCCEED("its header was refused");
    }
  }
}

TEST_CASE("bytes that do not decode as a message of their topic are refused") {
  msg::GroundTruth truth;
  truth.robots().resize(3);
  std::vector<std::uint8_t> bytes;
  append_cdr(topics::kTruth, &truth, bytes);
  int read = 0;
  const auto use = [&](const void* message) {
    ++read;
    CHECK(static_cast<const msg::GroundTruth*>(message)->robots().size() == 3);
  };
  CHECK(read_cdr(topics::kTruth, bytes, use));
  CHECK(read == 1);
  std::vector<std::uint8_t> empty;
  msg::GroundTruth without_robots;
  append_cdr(topics::kTruth, &without_robots, empty);
  auto hostile = bytes;
  for (std::size_t i = 0; i < 4; ++i) hostile[empty.size() - 4 + i] = 0xff;
  CHECK_FALSE(read_cdr(topics::kTruth, hostile, use));
  bytes.pop_back();
  CHECK_FALSE(read_cdr(topics::kTruth, bytes, use));
  CHECK_FALSE(read_cdr(topics::kTruth, {}, use));
  CHECK_FALSE(read_cdr(topics::kVerdict, bytes, use));
  CHECK(read == 1);
}

TEST_CASE("a file that is not a recording is refused with its name") {
  const TemporaryFile file;
  write(file.path, {'n', 'o'});
  CHECK_THROWS_WITH(PlaybackBus(file.path),
                    ContainsSubstring(file.path) && ContainsSubstring("is not a recording"));
  CHECK_THROWS_WITH(PlaybackBus("/nowhere/at/all"), ContainsSubstring("cannot be read"));
  CHECK_THROWS_WITH(RecordingWriter("/nowhere/at/all", {}), ContainsSubstring("cannot be written"));
}

}  // namespace sidestep::recording_test
