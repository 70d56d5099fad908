// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "common/config/scenario_loader.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"

// Messages of a run of two robots, as its metrics receive them.
namespace sidestep::run_metrics_test {

inline const Scenario kTwo = parse_scenario(
    "robots:\n"
    "- {id: 3, start_m: [0, 0], goals_m: [[1, 0]]}\n"
    "- {id: 7, team: yellow, start_m: [0, 1], goals_m: [[0.5, 1], [2, 1]]}\n",
    "two.yaml");

inline constexpr Time kBegin = time_from_ns(1'000'000'000'000);
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline Time after(double seconds) { return kBegin + from_seconds(seconds); }

inline msg::Header header_of(std::uint64_t incarnation, std::uint64_t number, double at_s) {
  msg::Header header;
  header.incarnation(incarnation);
  header.message_number(number);
  header.stamp_ns(to_ns(after(at_s)));
  return header;
}

inline msg::TrueRobotState body(RobotId robot, double x_m, double y_m, double vx_mps = 0) {
  msg::TrueRobotState truth;
  truth.robot(robot);
  truth.x_m(x_m);
  truth.y_m(y_m);
  truth.vx_mps(vx_mps);
  truth.reference_error_m(0.001);
  return truth;
}

inline msg::GroundTruth truth(std::uint64_t number, double at_s,
                              const std::vector<msg::TrueRobotState>& robots, std::uint64_t incarnation = 1) {
  msg::GroundTruth message;
  message.header(header_of(incarnation, number, at_s));
  message.valid_at_ns(to_ns(after(at_s)));
  message.min_clearance_m(0.3);
  message.robots(robots);
  return message;
}

inline msg::AgentStatus status(RobotId robot, std::uint64_t number, msg::AgentState agent_state,
                               std::uint64_t incarnation = 1) {
  msg::AgentStatus message;
  message.robot(robot);
  message.header(header_of(incarnation, number, 0));
  message.agent_state(agent_state);
  return message;
}

inline msg::RobotNotice missing_notice(RobotId robot) {
  msg::RobotNotice notice;
  notice.robot(robot);
  notice.is_missing(true);
  return notice;
}

inline msg::CoordinatorState state(std::uint64_t number, double at_s, msg::CoordinatorMode mode,
                                   std::uint64_t incarnation = 1) {
  msg::CoordinatorState message;
  message.header(header_of(incarnation, number, at_s));
  message.coordinator_mode(mode);
  return message;
}

inline constexpr auto kRegistering = msg::CoordinatorMode::COORDINATOR_REGISTERING;
inline constexpr auto kGranting = msg::CoordinatorMode::COORDINATOR_GRANTING;
inline constexpr auto kDriving = msg::AgentState::AGENT_DRIVING;
inline constexpr auto kFencing = msg::AgentState::AGENT_FENCING;
inline constexpr auto kArrived = msg::AgentState::AGENT_ARRIVED;

}  // namespace sidestep::run_metrics_test
