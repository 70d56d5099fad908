// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/monitor_recorder.hpp"

#include "common/config/scenario_loader.hpp"
#include "common/file/temporary_folder.hpp"
#include "deploy/monitor/record/playback_bus.hpp"
#include "deploy/monitor/view/monitor.hpp"
#include "deploy/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::monitor_recorder_test {

using namespace std::chrono_literals;

TEST_CASE("a monitor records from one moment to another, several times") {
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

}  // namespace sidestep::monitor_recorder_test
