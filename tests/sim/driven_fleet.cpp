// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/driven_fleet.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "agents/agent/planning_scratch.hpp"

namespace sidestep {
namespace {

constexpr Time kFleetBegin = time_from_ns(1'000'000'000'000);
constexpr Duration kSamplePeriod = std::chrono::milliseconds(100);
// A robot that was at its goal in so many samples has arrived.
constexpr int kSamplesAtGoal = 5;
constexpr double kAtGoal_m = 0.03;

}  // namespace

FleetDrive::FleetDrive(const Scenario& scenario, const BaseSettings& bases, const DriveSettings& drive,
                       std::uint64_t seed)
    : scenario_(scenario),
      network_(seed, kFleetBegin, scenario_.network),
      floor_(network_, scenario_, bases, drive, seed),
      coordinator_(coordinator_bus_, scenario_, {0, static_cast<Incarnation>(to_ns(kFleetBegin))}, false),
      samples_at_goal_(scenario_.robots.size(), 0) {
  observer_.become_observer();
  listen(observer_, scenario_, auditor_);
  auditor_.on_violation([this](const Violation& violation) {
    if (outcome_.first_violation.empty()) outcome_.first_violation = to_line(violation);
  });
  observer_.subscribe(topics::kTruth,
                      [this](const msg::GroundTruth& truth) { outcome_.contacts = truth.contacts(); });
  floor_.robots().on_event(LogLevel::kWarning, [this](const LogEvent& event) {
    if (event.text.find("makes its own stop") == std::string::npos) return;
    ++outcome_.own_stops;
    outcome_.own_stop_texts +=
        fmt::format("{:.1f} s: {}; ", to_seconds(network_.now() - kFleetBegin), event.text);
  });
  const auto scratch = std::make_shared<PlanningScratch>(scenario_);
  for (const RobotSpec& robot : scenario_.robots) {
    agent_buses_.push_back(std::make_unique<SimBus>(network_));
    agents_.push_back(std::make_unique<AgentNode>(*agent_buses_.back(), scenario_, robot.id,
                                                  static_cast<Incarnation>(to_ns(kFleetBegin)), scratch));
    last_m_.push_back(robot.start_m);
  }
}

FleetOutcome FleetDrive::run(Duration limit) {
  const Time end = network_.now() + limit;
  while (network_.now() < end && outcome_.arrived < scenario_.robots.size()) {
    network_.run_until(network_.now() + kSamplePeriod);
    sample();
  }
  outcome_.violations = auditor_.totals().violations;
  outcome_.creeping = free_ > 0 ? static_cast<double>(slow_) / free_ : 0;
  outcome_.mean_mps = free_ > 0 ? free_way_m_ / (free_ * to_seconds(kSamplePeriod)) : 0;
  return outcome_;
}

bool FleetDrive::is_free(std::size_t robot, const std::vector<Vec2>& now_m) const {
  const RobotSpec& spec = scenario_.robots[robot];
  const auto is_far = [&](const Vec2& place_m) { return (place_m - now_m[robot]).norm() > kFree_m; };
  if (!is_far(spec.start_m) || !is_far(spec.goals.back().position_m)) return false;
  for (std::size_t other = 0; other < now_m.size(); ++other) {
    if (other != robot && !is_far(now_m[other])) return false;
  }
  return true;
}

void FleetDrive::sample() {
  std::vector<Vec2> now_m;
  for (std::size_t i = 0; i < scenario_.robots.size(); ++i)
    now_m.push_back(floor_.world().bodies()[i].position_m());
  outcome_.arrived = 0;
  for (std::size_t i = 0; i < now_m.size(); ++i) {
    const bool is_at_goal = (now_m[i] - scenario_.robots[i].goals.back().position_m).norm() < kAtGoal_m;
    samples_at_goal_[i] = is_at_goal ? samples_at_goal_[i] + 1 : 0;
    const bool has_arrived = samples_at_goal_[i] >= kSamplesAtGoal;
    if (has_arrived)
      ++outcome_.arrived;
    else
      outcome_.minutes_driven += to_seconds(kSamplePeriod) / 60;
    if (!is_free(i, now_m)) continue;
    const double way_m = (now_m[i] - last_m_[i]).norm();
    ++free_;
    free_way_m_ += way_m;
    if (!(way_m >= kCreeping_mps * to_seconds(kSamplePeriod))) ++slow_;
  }
  last_m_ = now_m;
}

}  // namespace sidestep
