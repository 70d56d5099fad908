// SPDX-License-Identifier: Apache-2.0
#include "common/process/host_clock_watch.hpp"

#include <vector>

#include "common/messaging/sim/bus.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"

namespace sidestep::host_clock_watch_test {

using namespace std::chrono_literals;

/// A process with a wrong clock, whose host's clock is set during the test, and a process with the right
/// clock that sends a heartbeat and a robot report every 20 ms.
struct Scene {
  SimNetwork network{1, time_from_ns(1'700'000'000'000'000'000), NetworkSpec{}};
  SimBus bus, other;
  Duration host_ahead{0};
  bool is_in_use = false;
  int adopted = 0;
  std::vector<Duration> steps;
  Writer<msg::CoordinatorState> heartbeats;
  Writer<msg::Feedback> robot_reports;
  HostClockWatch watch;

  Scene(ClockReference reference, Duration own_ahead)
      : bus(network, {network.new_process(), {own_ahead, 0, {}}}),
        other(network),
        heartbeats(other.advertise(topics::kCoordinator)),
        robot_reports(other.advertise(topics::kFeedback, 3)),
        watch(bus, reference, Duration{0},
              {[this] { return host_ahead; }, [this] { return is_in_use; }, [this] { ++adopted; },
               [this](Duration step) { steps.push_back(step); }}) {
    if (reference == ClockReference::kRobots)
      bus.subscribe(topics::kFeedback, 3, [](const msg::Feedback&) {});
  }
  void run(Duration duration, bool with_heartbeats, bool with_reports) {
    for (const Time end = network.now() + duration; network.now() < end;) {
      msg::CoordinatorState state;
      state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
      if (with_heartbeats) heartbeats.publish(state, other.now());
      msg::Feedback robot_report;
      robot_report.header().sender(3);
      if (with_reports) robot_reports.publish(robot_report, other.now());
      network.run_until(network.now() + 20ms);
    }
  }
};

TEST_CASE("a process adopts its host's new clock after some seconds if its references agree") {
  const ClockReference reference = GENERATE(ClockReference::kCoordinators, ClockReference::kRobots);
  const bool uses_heartbeats = reference == ClockReference::kCoordinators;
  CAPTURE(uses_heartbeats);
  Scene scene(reference, -24h);
  scene.run(10s, true, true);
  CHECK(scene.adopted == 0);
  CHECK(scene.steps.empty());
  scene.host_ahead = 24h;
  scene.run(20s, !uses_heartbeats, uses_heartbeats);  // messages from other processes do not count
  CHECK(scene.adopted == 0);
  CHECK(scene.steps == std::vector<Duration>{24h});
  scene.run(5s, true, true);
  CHECK(scene.adopted == 1);
}

TEST_CASE("a process that is in use or has the right clock keeps it when the host's clock is set") {
  const bool is_right = GENERATE(true, false);
  CAPTURE(is_right);
  Scene scene(ClockReference::kCoordinators, is_right ? Duration(0s) : Duration(-1h));
  scene.is_in_use = !is_right;
  scene.host_ahead = 1h;
  scene.run(20s, true, true);
  CHECK(scene.adopted == 0);
  CHECK(scene.steps.size() == 1);
  scene.host_ahead = 0s;
  scene.run(2s, true, true);
  CHECK(scene.steps.size() == 2);
}

}  // namespace sidestep::host_clock_watch_test
