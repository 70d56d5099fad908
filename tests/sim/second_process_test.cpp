// SPDX-License-Identifier: Apache-2.0
// Two processes of kinds that may run only once in a domain.
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "common/config/scenario_loader.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/sim/disturbance.hpp"
#include "tests/sim/ordered_system.hpp"

namespace sidestep::second_process_test {

using namespace std::chrono_literals;

Scenario circle(int coordinators = 1) {
  return parse_scenario("coordinators: " + std::to_string(coordinators) +
                            "\ntime_limit_s: 120\nfield: {length_m: 6, width_m: 6}\n"
                            "circle: {count: 8, spacing_m: 0.6}\n",
                        "circle.yaml");
}

/// Records the first simulator's ground truth, and what processes report.
struct Watch {
  SimSystem& system;
  SimBus bus;
  Incarnation first = 0;
  std::uint64_t contacts = 0, firmware_violations = 0;
  std::map<RobotId, Vec2> velocities_mps;
  std::set<std::string> reported;  ///< "process: text"

  explicit Watch(SimSystem& observed) : system(observed), bus(observed.network()) {
    bus.become_observer();
    bus.observe(topics::kTruth, 0, [this](const msg::GroundTruth& truth) {
      if (first == 0) first = truth.header().incarnation();
      if (truth.header().incarnation() != first) return;
      contacts = truth.contacts();
      firmware_violations = truth.firmware_violations();
      for (const msg::TrueRobotState& robot : truth.robots())
        velocities_mps[robot.robot()] = {robot.vx_mps(), robot.vy_mps()};
    });
    system.on_event(LogLevel::kError, [this](const std::string& process, const LogEvent& event) {
      reported.insert(process + ": " + event.text);
    });
  }
  bool has_reported(const std::string& process, const std::string& words) const {
    return std::ranges::any_of(reported, [&](const std::string& line) {
      return line.starts_with(process + ": ") && line.find(words) != std::string::npos;
    });
  }
  double max_speed_mps() const {
    double result = 0;
    for (const auto& [robot, velocity] : velocities_mps) result = std::max(result, velocity.norm());
    return result;
  }
  void require_safe() const {
    REQUIRE(contacts == 0);
    REQUIRE(firmware_violations == 0);
    const Report report = system.metrics().report();
    for (const Violation& violation : report.audit->first) UNSCOPED_INFO(to_line(violation));
    REQUIRE(report.audit->violations == 0);
  }
};

TEST_CASE(
    "a second simulator exits at any time of a run, and the first simulator's robots arrive without "
    "contact") {
  const auto seed = GENERATE(range(1u, 41u));
  CAPTURE(seed);
  Rng rng(seed);
  SimSystem system(circle(seed % 2 == 0 ? 1 : 2), seed);
  Watch watch(system);
  system.run_for(from_seconds(rng.uniform(0, 6)));
  system.restart(second_process("simulator"));
  system.run_for(3s);
  CHECK_FALSE(system.is_alive(second_process("simulator")));
  CHECK(system.is_alive("simulator"));
  CHECK_FALSE(system.was_second_simulator_accepted());
  CHECK(watch.has_reported(second_process("simulator"), "another simulator is running in this domain"));
  CHECK(system.run_until_arrived(system.now() + 60s));
  watch.require_safe();
}

TEST_CASE(
    "while two simulators run, robots stay at rest, and every process that hears both reports the conflict") {
  const auto seed = GENERATE(range(1u, 21u));
  CAPTURE(seed);
  Rng rng(seed);
  SimSystem system(circle(), seed);
  Watch watch(system);
  system.keep_duplicates_running();
  system.run_for(from_seconds(rng.uniform(0.5, 3)));
  system.restart(second_process("simulator"));
  system.run_for(3s);
  CHECK(watch.max_speed_mps() < 0.02);
  CHECK(watch.has_reported("vision", "two processes send 'detections' as simulator"));
  CHECK(watch.has_reported("coordinator", "two processes send 'feedback/3' as robot 3"));
  CHECK(watch.has_reported("agent 3", "two processes send 'feedback/3' as robot 3"));
  CHECK(watch.has_reported("simulator", "another simulator is running in this domain"));
  system.run_for(from_seconds(rng.uniform(1, 20)));
  CHECK(watch.max_speed_mps() < 0.02);
  watch.require_safe();
  system.kill(second_process("simulator"));
  CHECK(system.run_until_arrived(system.now() + 60s));
  watch.require_safe();
}

TEST_CASE("a silent robot for which only a second simulator reports causes no audit violation") {
  const auto seed = GENERATE(range(1u, 11u));
  CAPTURE(seed);
  Rng rng(seed);
  SimSystem system(circle(), seed);
  Watch watch(system);
  system.keep_duplicates_running();
  system.run_for(from_seconds(rng.uniform(0.5, 3)));
  for (const auto kind :
       {msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF, msg::DisturbanceKind::DISTURBANCE_LIFT}) {
    auto taken_away = disturbance(3, kind);
    system.disturb(taken_away);
  }
  system.run_for(8s);
  system.restart(second_process("simulator"));
  system.run_for(3s);
  CHECK(system.was_second_simulator_accepted());
  watch.require_safe();
}

TEST_CASE(
    "a silent robot for which a second simulator reported is judged by the robot's own reports afterwards") {
  const auto seed = GENERATE(range(1u, 6u));
  CAPTURE(seed);
  Rng rng(seed);
  SimSystem system(waiting_robots(4), seed);
  Watch watch(system);
  system.keep_duplicates_running();
  system.run_for(from_seconds(rng.uniform(1.5, 3)));
  auto off = disturbance(3, msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF),
       on = disturbance(3, msg::DisturbanceKind::DISTURBANCE_SWITCH_ON);
  system.disturb(off);
  system.run_for(3s);
  system.restart(second_process("simulator"));
  system.run_for(from_seconds(rng.uniform(0.5, 3)));
  system.kill(second_process("simulator"));
  system.run_for(8s);
  system.disturb(on);
  system.run_for(5s);
  for (const RobotId robot : {0u, 1u, 2u, 3u}) {
    Order order{msg::OrderKind::ORDER_GO, robot, kClient, static_cast<OrderNumber>(to_ns(system.now()))};
    order.goals = {{{0.5 * robot - 1, 1}}};
    system.send(order);
  }
  system.run_for(1s);
  CHECK(watch.max_speed_mps() > 0.3);
  system.run_for(5s);
  watch.require_safe();
}

TEST_CASE("two simulators on a lossy network cause no contact, even if other processes restart") {
  const auto seed = GENERATE(range(1u, 31u));
  CAPTURE(seed);
  Rng rng(seed);
  Scenario scenario = circle(2);
  scenario.network = {rng.uniform(0, 0.3), 0.1, 1ms, from_seconds(rng.uniform(0.002, 0.05))};
  SimSystem system(scenario, seed);
  Watch watch(system);
  if (rng.chance(0.5)) system.keep_duplicates_running();
  system.run_for(from_seconds(rng.uniform(0.5, 4)));
  system.restart(second_process("simulator"));
  for (int i = 0; i < 6; ++i) {
    system.run_for(from_seconds(rng.uniform(0.1, 1.5)));
    const std::string process = rng.chance(0.4)   ? "vision"
                                : rng.chance(0.5) ? coordinator_process(static_cast<int>(rng.below(2)))
                                                  : agent_process(static_cast<RobotId>(rng.below(8)));
    system.kill(process);
    system.run_for(from_seconds(rng.uniform(0, 0.3)));
    system.restart(process);
  }
  system.kill(second_process("simulator"));
  system.run_for(20s);
  watch.require_safe();
}

TEST_CASE("a second vision process exits, and robots arrive") {
  const auto seed = GENERATE(range(1u, 21u));
  CAPTURE(seed);
  Rng rng(seed);
  SimSystem system(circle(), seed);
  Watch watch(system);
  system.run_for(from_seconds(rng.uniform(0, 6)));
  system.restart(second_process("vision"));
  system.run_for(3s);
  CHECK_FALSE(system.is_alive(second_process("vision")));
  CHECK(watch.has_reported(second_process("vision"), "another vision is running in this domain"));
  CHECK(system.run_until_arrived(system.now() + 60s));
  watch.require_safe();
}

TEST_CASE("two coordinators with the same number report each other, and robots arrive") {
  const auto seed = GENERATE(range(1u, 21u));
  CAPTURE(seed);
  Rng rng(seed);
  SimSystem system(circle(2), seed);
  Watch watch(system);
  system.run_for(from_seconds(rng.uniform(0, 3)));
  system.restart(second_process("coordinator"));
  system.run_for(3s);
  CHECK(watch.has_reported("coordinator", "another coordinator is running in this domain"));
  CHECK(watch.has_reported(second_process("coordinator"), "another coordinator is running in this domain"));
  CHECK(system.run_until_arrived(system.now() + 60s));
  watch.require_safe();
}

TEST_CASE("a simulator that restarts does not count as a second simulator") {
  SimSystem system(circle(), 1);
  Watch watch(system);
  system.run_for(2s);
  system.kill("simulator");
  system.run_for(300ms);
  system.restart("simulator");
  system.run_for(5s);
  CHECK(system.is_alive("simulator"));
  CHECK(watch.reported.empty());
}

}  // namespace sidestep::second_process_test
