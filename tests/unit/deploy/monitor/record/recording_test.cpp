// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/record/recording.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/cdr.hpp"
#include "common/random/rng.hpp"
#include "deploy/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

const std::string kScenario = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";

/// A file that goes with the test.
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

/// Records the crossing for a while; what the auditor heard meanwhile.
AuditTotals record_run(const std::string& path, Duration duration) {
  const Scenario scenario = load_scenario(kScenario);
  RecordingHead head = recording_head(scenario.name, kScenario);
  head.is_complete = true;
  RecordingWriter writer(path, head);
  SimSystem system(scenario, 3);
  SimBus bus(system.network());
  bus.listen_aside();
  record(bus, scenario, writer);
  system.run_for(duration);
  writer.close();
  return system.auditor().totals();
}

struct Played {
  AuditTotals audit;
  RecordingEnd end;
};

Played play(const std::string& path) {
  PlaybackBus bus(path);
  const Scenario scenario = parse_scenario(bus.head().text, "crossing.yaml");
  Auditor auditor(scenario, {bus.head().is_complete, {}});
  listen(bus, scenario, auditor);
  const RecordingEnd end = bus.play();
  return {auditor.totals(), end};
}

}  // namespace

TEST_CASE("a recording is heard again as it was") {
  const TemporaryFile file;
  const AuditTotals live = record_run(file.path, 2s);
  const Played again = play(file.path);
  CHECK(again.end.damage == "");
  CHECK(again.end.unreadable == 0);
  CHECK(again.end.messages > live.heard);  // frames and statuses too
  CHECK(again.audit.pairs == live.pairs);
  CHECK(again.audit.violations == 0);
  // But for what was said while the system was made.
  CHECK(again.audit.heard <= live.heard);
  CHECK(again.audit.heard + 20 > live.heard);
}

/// Where blocks end: 8 bytes of magic, then blocks of a size, a check sum and so many bytes.
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

TEST_CASE("a recording that ends anywhere is used up to there, and said to be cut off") {
  const TemporaryFile file;
  record_run(file.path, 1s);
  const auto whole = contents(file.path);
  const auto ends = block_ends(whole);
  REQUIRE(ends.contains(whole.size()));
  std::uint64_t before = 0;
  const std::size_t head = 8 + 8 + 2000;  // magic, frame, and more than the scenario's text would fit
  for (std::size_t size = whole.size() / 10 + head; size < whole.size(); size += whole.size() / 10 + 1) {
    CAPTURE(size);
    write(file.path, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    const Played heard = play(file.path);
    CHECK(heard.end.messages > before);
    CHECK(heard.end.damage == (ends.contains(size) ? "" : "it ends in the middle of a block"));
    CHECK(heard.audit.violations == 0);
    before = heard.end.messages;
  }
}

TEST_CASE("whatever is in a file, reading it ends without harm") {
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
      const RecordingEnd end = PlaybackBus(file.path).play();
      CHECK((broken == whole || !end.damage.empty()));
    } catch (const std::runtime_error&) {
      SUCCEED("its head was refused");
    }
  }
}

TEST_CASE("bytes that are no message of their topic are refused") {
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
  msg::GroundTruth nobody;
  append_cdr(topics::kTruth, &nobody, empty);
  auto hostile = bytes;
  for (std::size_t i = 0; i < 4; ++i) hostile[empty.size() - 4 + i] = 0xff;
  CHECK_FALSE(read_cdr(topics::kTruth, hostile, use));
  bytes.pop_back();
  CHECK_FALSE(read_cdr(topics::kTruth, bytes, use));
  CHECK_FALSE(read_cdr(topics::kTruth, {}, use));
  CHECK_FALSE(read_cdr(topics::kVerdict, bytes, use));
  CHECK(read == 1);
}

TEST_CASE("what is no recording is refused by name") {
  const TemporaryFile file;
  write(file.path, {'n', 'o'});
  CHECK_THROWS_WITH(PlaybackBus(file.path), Catch::Contains(file.path) && Catch::Contains("is no recording"));
  CHECK_THROWS_WITH(PlaybackBus("/nowhere/at/all"), Catch::Contains("cannot be read"));
  CHECK_THROWS_WITH(RecordingWriter("/nowhere/at/all", {}), Catch::Contains("cannot be written"));
}

}  // namespace sidestep
