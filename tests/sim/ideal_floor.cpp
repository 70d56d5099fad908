// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/ideal_floor.hpp"

#include <algorithm>

#include "tests/catch.hpp"

namespace sidestep {
namespace {

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr Duration kCheckPeriod{5'000'000};

}  // namespace

IdealFloor::IdealFloor(const Scenario& s, std::uint64_t seed, AuditInput audit_input)
    : scenario(s),
      network(seed, kBegin, s.network),
      robots(robots_bus, scenario),
      auditor_(scenario, audit_input),
      rng_(seed) {
  audit_bus_.become_observer();
  listen(audit_bus_, scenario, auditor_);
  for (int number = 0; number < scenario.coordinators; ++number)
    start_coordinator(static_cast<CoordinatorNumber>(number));
  for (const RobotSpec& robot : scenario.robots) start_agent(robot.id);
}

std::uint64_t IdealFloor::violations() const {
  const AuditTotals totals = auditor_.totals();
  for (const Violation& violation : totals.first) UNSCOPED_INFO(to_line(violation));
  return totals.violations;
}

Incarnation IdealFloor::next_incarnation() {
  const auto now = static_cast<Incarnation>(to_ns(network.now()));
  return last_incarnation_ = std::max(last_incarnation_ + 1, now + rng_.below(1'000'000));
}

void IdealFloor::start_coordinator(CoordinatorNumber number) {
  auto& process = coordinators_.try_emplace(number, network).first->second;
  const CoordinatorIdentity self{number, next_incarnation()};
  process.node = std::make_unique<CoordinatorNode>(process.bus, scenario, self, scenario.coordinators > 1);
}

int IdealFloor::granting_coordinator() {
  int found = -1;
  for (const auto& [number, process] : coordinators_) {
    if (!process.node->coordinator().is_granting()) continue;
    if (found >= 0) return -1;
    found = static_cast<int>(number);
  }
  return found;
}

FaultyBus& IdealFloor::start_agent(RobotId robot) {
  auto& process = agents_.emplace(robot, network)->second;
  process.node = std::make_unique<AgentNode>(process.bus, scenario, robot, next_incarnation(), scratch_);
  return process.bus;
}

std::vector<FaultyBus*> IdealFloor::agent_buses(RobotId robot) {
  std::vector<FaultyBus*> buses;
  const auto [begin, end] = agents_.equal_range(robot);
  for (auto at = begin; at != end; ++at) buses.push_back(&at->second.bus);
  return buses;
}

double IdealFloor::run(double seconds) {
  double min_clearance = 1e9;
  const Time end = network.now() + from_seconds(seconds);
  while (network.now() < end) {
    network.run_until(std::min(end, network.now() + kCheckPeriod));
    min_clearance = std::min(min_clearance, robots.clearance_m(network.now()));
    compare_with_ledger();
  }
  return min_clearance;
}

void IdealFloor::compare_with_ledger() {
  const Coordinator* in_charge = nullptr;
  for (const auto& [number, process] : coordinators_) {
    const Coordinator& coordinator = process.node->coordinator();
    if (coordinator.is_granting() && (!in_charge || coordinator.epoch() > in_charge->epoch()))
      in_charge = &coordinator;
  }
  if (!in_charge) return;
  for (const RobotSpec& robot : scenario.robots) {
    if (!robots.is_on_floor(robot.id)) continue;
    const Version& executing = robots.executing(robot.id, network.now());
    const auto held = in_charge->ledger().versions(robot.id);
    const auto is_same = [&](const Version& version) { return version.number == executing.number; };
    const auto is_older = [&](const Version& version) { return version.number < executing.number; };
    const bool is_unreported_stop = robots.is_off_reference(robot.id) && std::ranges::all_of(held, is_older);
    unknown_versions_ += std::ranges::none_of(held, is_same) && !is_unreported_stop;
  }
}

int IdealFloor::arrived() {
  int count = 0;
  for (const RobotSpec& robot : scenario.robots) {
    const double distance_m =
        (robots.position_m(robot.id, network.now()) - robot.goals.back().position_m).norm();
    count += distance_m < scenario.goal_tolerance_m;
  }
  return count;
}

double IdealFloor::run_until_arrived(double max_seconds) {
  double min_clearance = 1e9;
  const Time end = network.now() + from_seconds(max_seconds);
  while (network.now() < end && arrived() < static_cast<int>(scenario.robots.size()))
    min_clearance = std::min(min_clearance, run(0.05));
  return min_clearance;
}

bool IdealFloor::run_until_speed(double speed) {
  const Time end = network.now() + std::chrono::seconds(10);
  while (network.now() < end && max_speed_mps() < speed) (void)run(0.005);
  return max_speed_mps() >= speed;
}

double IdealFloor::speed_mps(RobotId robot) { return robots.velocity_mps(robot, network.now()).norm(); }

double IdealFloor::max_speed_mps() {
  double max_speed = 0;
  for (const RobotSpec& robot : scenario.robots) max_speed = std::max(max_speed, speed_mps(robot.id));
  return max_speed;
}

}  // namespace sidestep
