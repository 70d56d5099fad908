// SPDX-License-Identifier: Apache-2.0
// Robots that receive fixes rarely and late.
#include "common/config/scenario_loader.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::drift_test {

using namespace std::chrono_literals;

TEST_CASE("with rare and late vision, robots drive slowly enough to stay on their references") {
  std::uint64_t own_stops = 0;
  double max_position_error_m = 0;
  Scenario scenario = load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/two-teams-22.yaml");
  // On a slow network, clock offsets would limit the speed more than dead reckoning does.
  scenario.vision.rate_hz = 10;
  scenario.vision.delay = 100ms;
  scenario.odometry.scale_error = 0.01;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    CAPTURE(seed);
    SimSystem system(scenario, seed);
    SimBus bus(system.network());
    bus.become_observer();
    std::map<RobotId, VersionNumber> stops;
    for (const RobotSpec& robot : scenario.robots) {
      bus.subscribe(topics::kFeedback, robot.id, std::function([&](const msg::Feedback& feedback) {
                      VersionNumber& last = stops[feedback.robot()];
                      const VersionNumber now = feedback.executing().version_number();
                      own_stops += feedback.is_off_reference() && now > last;
                      last = std::max(last, now);
                    }));
    }
    system.run_for(12s);
    const Report report = system.metrics().report();
    REQUIRE(report.contacts == 0);
    REQUIRE(report.audit->violations == 0);
    REQUIRE(report.grants > 2000);
    max_position_error_m = std::max(max_position_error_m, report.audit->max_position_error_m);
  }
  WARN("at most " << max_position_error_m * 1e3 << " mm from their references");
  // One robot in several hundred has odometry so bad that four standard deviations do not cover it.
  CHECK(own_stops <= 1);
  CHECK(max_position_error_m < scenario.tracking_bound_m);
}

}  // namespace sidestep::drift_test
