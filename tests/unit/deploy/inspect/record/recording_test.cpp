// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/recording.hpp"

#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/config/scenario_loader.hpp"
#include "common/file/temporary_folder.hpp"
#include "common/json/json_text.hpp"
#include "common/messaging/cdr.hpp"
#include "common/random/rng.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::recording_test {

using namespace std::chrono_literals;

const std::string kScenario = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";

std::vector<char> contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const std::string& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Records a scenario for `duration` and returns the totals of the live auditor. `prepare` may change the
/// system before it runs.
AuditTotals record_run(
    const std::string& path, Duration duration,
    const std::function<void(SimSystem&)>& prepare = [](SimSystem&) {},
    const std::string& scenario_file = kScenario, const McapWriterSettings& settings = {}) {
  const Scenario scenario = load_scenario(scenario_file);
  RecordingHeader header = recording_header(scenario, scenario_file);
  header.is_complete = true;
  RecordingWriter writer(path, header, settings);
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
  const Scenario scenario = bus.scenario();
  Auditor auditor(scenario, {bus.header().is_complete, {}});
  refuse_other_rules(bus, scenario, auditor);
  listen(bus, scenario, auditor);
  const PlaybackResult result = bus.play();
  return {auditor.totals(), result};
}

TEST_CASE("a recording plays back the messages of the run") {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.mcap");
  const AuditTotals live = record_run(file, 2s);
  const AuditedPlayback again = play(file);
  CHECK(again.result.damage == "");
  CHECK(again.result.unreadable == 0);
  CHECK(again.result.messages > live.received);  // detection frames and agent status were recorded too
  CHECK(again.audit.compared_pairs == live.compared_pairs);
  CHECK(again.audit.violations == 0);
  CHECK(again.audit.refused == 0);
  CHECK(again.audit.verdict() == AuditVerdict::kPassed);
  // Messages sent during the construction of the system are not recorded.
  CHECK(again.audit.received <= live.received);
  CHECK(again.audit.received + 20 > live.received);
}

TEST_CASE("the audit of a recording refuses and counts messages of processes with different rules") {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.mcap");
  record_run(file, 500ms, [](SimSystem& system) {
    Scenario changed = load_scenario(kScenario);
    changed.margin_m = 0.05;
    system.use_scenario(twin_process(3), changed);
    system.restart(twin_process(3));
  });
  const AuditedPlayback played = play(file);
  CHECK(played.audit.refused > 10);
  CHECK(played.audit.violations == 0);
}

TEST_CASE("a compressed recording plays back the same messages and is smaller") {
  const TemporaryFolder folder;
  const std::string plain = folder.file("plain.mcap"), compressed = folder.file("compressed.mcap");
  record_run(plain, 1s);
  record_run(compressed, 1s, [](SimSystem&) {}, kScenario, {.is_compressed = true});
  const AuditedPlayback first = play(plain), second = play(compressed);
  CHECK(first.result.messages == second.result.messages);
  CHECK(first.audit.compared_pairs == second.audit.compared_pairs);
  CHECK(second.result.damage == "");
  CHECK(contents(compressed).size() < contents(plain).size() / 2);
}

TEST_CASE("a recording in a building contains the map") {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.mcap");
  const std::string house = SIDESTEP_SOURCE_DIR "/deploy/scenarios/house.yaml";
  const AuditTotals live = record_run(
      file, 1s, [](SimSystem&) {}, house);
  CHECK(PlaybackBus(file).scenario().map->fingerprint() == load_scenario(house).map->fingerprint());
  const AuditedPlayback again = play(file);
  CHECK(again.audit.compared_pairs == live.compared_pairs);
  CHECK(again.audit.verdict() == AuditVerdict::kPassed);
}

TEST_CASE("a truncated recording is played up to the cut, and the truncation is reported") {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.mcap");
  const bool is_compressed = GENERATE(false, true);
  CAPTURE(is_compressed);
  record_run(file, 3s, [](SimSystem&) {}, kScenario, {.is_compressed = is_compressed});
  const auto whole = contents(file);
  const std::uint64_t all = play(file).result.messages;
  std::uint64_t before = 0;
  for (std::size_t tenth = 2; tenth < 10; ++tenth) {
    CAPTURE(tenth);
    const std::size_t size = whole.size() * tenth / 10;
    write(file, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    const AuditedPlayback played = play(file);
    CHECK(played.result.messages > before);
    // The file grows nearly in proportion to the messages, except within compressed blocks.
    CHECK(played.result.messages > static_cast<double>(all * tenth) / 10 * (is_compressed ? 0.6 : 0.9));
    CHECK(played.result.messages < all);
    CHECK(played.result.damage != "");
    CHECK(played.audit.violations == 0);
    before = played.result.messages;
  }
}

TEST_CASE("playing a corrupted recording does no harm") {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.mcap");
  record_run(file, 300ms);
  const auto whole = contents(file);
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    auto broken = whole;
    const std::size_t from = seed % 3 == 0 ? 0 : 8;
    for (std::uint64_t i = 0; i <= rng.below(8); ++i)
      broken[from + rng.below(broken.size() - from)] = static_cast<char>(rng.bits());
    write(file, broken);
    try {
      const PlaybackResult result = PlaybackBus(file).play();
      INFO(result.damage);
      CHECK((broken == whole || !result.damage.empty()));
    } catch (const std::invalid_argument&) {
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

TEST_CASE("a file that is not a recording is rejected with its name") {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.mcap");
  write(file, {'n', 'o'});
  CHECK_THROWS_AS(PlaybackBus(file), std::invalid_argument);  // as for any invalid file, exit code 2
  CHECK_THROWS_WITH(PlaybackBus(file), ContainsSubstring(file) && ContainsSubstring("is not an MCAP file"));
  CHECK_THROWS_WITH(PlaybackBus("/nowhere/at/all"), ContainsSubstring("cannot be read"));
  CHECK_THROWS_WITH(RecordingWriter("/nowhere/at/all", {}), ContainsSubstring("cannot write "));
}

TEST_CASE("a recording shows the robots in other programs' 3-D panels") {
  const TemporaryFolder folder;
  record_run(folder.file("a.mcap"), 2s);
  McapReader reader(folder.file("a.mcap"));
  int scenes = 0;
  for (McapRecord next = reader.next(); !std::holds_alternative<std::monostate>(next); next = reader.next()) {
    const auto* message = std::get_if<McapMessage>(&next);
    if (message == nullptr || reader.channel(*message).topic != "scene_update") continue;
    CHECK(reader.channel(*message).message_encoding == "json");
    CHECK(reader.schema(reader.channel(*message))->name == "foxglove.SceneUpdate");
    const auto json =
        parse_json({reinterpret_cast<const char*>(message->payload.data()), message->payload.size()});
    if (++scenes == 6)
      CHECK(json.at("entities").at(0).at("cylinders").size() == load_scenario(kScenario).robots.size());
  }
  CHECK(scenes >= 7);
}

TEST_CASE("events of the run that are not messages are recorded and played back in order") {
  const TemporaryFolder folder;
  {
    RecordingWriter writer(folder.file("a.mcap"), {"one", "robots: []\n", nullptr, true});
    writer.add_event(time_from_ns(5'000'000'000), "bookmark", "here: \"äö\"");
    const msg::GroundTruth truth;
    writer.add(time_from_ns(6'000'000'000), topics::kTruth, writer.add_channel(topics::kTruth, "truth"),
               truth.header(), &truth);
    writer.add_event(time_from_ns(7'000'000'000), "death", "agent 3 died");
    writer.close();
  }
  PlaybackBus bus(folder.file("a.mcap"));
  std::string events;
  bus.on_event([&](Time at, const std::string& kind, const std::string& text) {
    events += std::to_string(to_ns(at) / 1'000'000'000) + " " + kind + " " + text + ";";
  });
  bus.observe<msg::GroundTruth>(topics::kTruth, 0, [&](const msg::GroundTruth&) { events += "truth;"; });
  CHECK(bus.play().damage.empty());
  CHECK(events == "5 bookmark here: \"äö\";truth;7 death agent 3 died;");
}

}  // namespace sidestep::recording_test
