// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor_recorder.hpp"

#include <nlohmann/json.hpp>

#include "common/config/scenario_loader.hpp"
#include "common/file/temporary_folder.hpp"
#include "common/json/json_text.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "deploy/view/monitor/monitor.hpp"
#include "deploy/view/monitor/recorded_messages.hpp"
#include "tests/catch.hpp"

namespace sidestep::monitor_recorder_test {

using namespace std::chrono_literals;

TEST_CASE("a monitor can record several intervals of a run") {
  const std::string file = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";
  const Scenario scenario = load_scenario(file);
  const TemporaryFolder folder;
  SimSystem system(scenario, 1);
  SimBus bus(system.network());
  bus.become_observer();
  MonitorSettings settings;
  settings.scenario = &scenario;
  Monitor monitor(bus, settings);
  MonitorRecorder recorder(scenario, file);
  std::uint64_t received = 0;
  monitor.on_any_message([&](const AnyMessage& message) {
    recorder.add(message, bus.now());
    received += recorder.is_recording();
  });
  system.run_for(1s);
  CHECK(received == 0);
  for (const char* name : {"a.mcap", "b.mcap"}) {
    received = 0;
    recorder.start(folder.file(name));
    system.run_for(1s);
    recorder.add_event(bus.now(), "bookmark", name);
    recorder.flush();
    system.run_for(1s);
    recorder.stop();
    recorder.stop();
    CHECK(recorder.file() == folder.file(name));
    PlaybackBus playback(folder.file(name));
    std::string events;
    std::map<RobotId, std::uint64_t> feedbacks;
    playback.on_event(
        [&](Time, const std::string& kind, const std::string& text) { events += kind + " " + text; });
    for (const RobotSpec& robot : scenario.robots)
      playback.observe<msg::Feedback>(topics::kFeedback, robot.id, [&](const msg::Feedback& feedback) {
        CHECK(feedback.robot() == robot.id);
        ++feedbacks[robot.id];
      });
    const PlaybackResult result = playback.play();
    CHECK(result.damage.empty());
    CHECK(result.messages == received);
    CHECK(events == std::string("bookmark ") + name);
    for (const RobotSpec& robot : scenario.robots) CHECK(feedbacks[robot.id] >= 90);  // about sixty a second
    CHECK_FALSE(playback.header().is_complete);
  }
}

TEST_CASE("a full disk ends the monitor's recording with a message, and another can be started") {
  const std::string file = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";
  const Scenario scenario = load_scenario(file);
  const TemporaryFolder folder;
  MonitorRecorder recorder(scenario, file);
  std::vector<std::string> failures;
  recorder.on_failure([&](const std::string& failure) { failures.push_back(failure); });
  recorder.start("/dev/full");
  CHECK(failures == std::vector<std::string>{"/dev/full: No space left on device"});
  CHECK_FALSE(recorder.is_recording());
  recorder.add_event(Time{}, "bookmark", "lost");
  recorder.flush();
  CHECK_THROWS_WITH(recorder.stop(), "/dev/full: No space left on device");
  recorder.stop();
  recorder.start("/dev/full");
  recorder.start(folder.file("a.mcap"));
  CHECK(recorder.is_recording());
  recorder.stop();
  CHECK(failures.size() == 2);
}

TEST_CASE("the messages of a channel of a recording are found in any interval") {
  const std::string file = SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml";
  const Scenario scenario = load_scenario(file);
  const TemporaryFolder folder;
  std::vector<std::pair<Time, double>> received;
  {
    SimSystem system(scenario, 1);
    SimBus bus(system.network());
    bus.become_observer();
    // Small chunks, so that the interval spans many of them.
    RecordingWriter writer(folder.file("a.mcap"), recording_header(scenario, file),
                           {true, 1'000'000'000, 20'000});
    record(bus, scenario, writer);
    SimBus other(system.network());
    other.become_observer();
    other.observe<msg::Feedback>(topics::kFeedback, 1, [&](const msg::Feedback& feedback) {
      received.emplace_back(other.now(), feedback.x_m());
    });
    system.run_for(6s);
    writer.close();
  }
  PlaybackBus playback(folder.file("a.mcap"));
  RecordedMessages recorded(folder.file("a.mcap"), playback);
  CHECK(recorded.between("feedback/1", Time{}, Time::max() - 1h).empty());  // nothing has been read yet
  CHECK(playback.play().damage.empty());
  CHECK(playback.chunks().size() > 20);
  for (const auto& [from, to] :
       std::vector<std::pair<std::size_t, std::size_t>>{{0, 50}, {100, 101}, {200, 300}, {10, 40}}) {
    const std::vector<std::string> found =
        recorded.between("feedback/1", received[from].first, received[to].first);
    REQUIRE(found.size() == to - from);
    for (std::size_t i = 0; i < found.size(); ++i)
      CHECK(parse_json(found[i]).at("message").at("x_m") == Approx(received[from + 1 + i].second));
  }
  CHECK(recorded.between("feedback/1", received.back().first, received.back().first + 1h).empty());
  CHECK(recorded.between("feedback/x", Time{}, received.back().first).empty());
}

}  // namespace sidestep::monitor_recorder_test
