// SPDX-License-Identifier: Apache-2.0
#include "coordinator/fleet_reception.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// A robot that has been silent for longer than this does not count in hears_robots().
constexpr Duration kForgetAfter{10'000'000'000};
// An agent of a resting robot sends one message a second, the status of its order.
constexpr Duration kMaxAgentSilence{2'500'000'000};
// Agents stop if the coordinator has not compared observations with the ledger for this long.
constexpr Duration kMaxVisionSilence{600'000'000};

}  // namespace

void FleetReception::on_robot_report(RobotId robot, VersionNumber executing, bool is_granted, Time now) {
  Robot& known = robots_[robot];
  if (is_granted && known.report_at && executing > known.executing) served_at_ = now;
  known.report_at = now;
  known.executing = std::max(known.executing, executing);
}

void FleetReception::on_agent(RobotId robot, Time now) { robots_[robot].agent_at = now; }

void FleetReception::on_registration(RobotId robot, Time now) {
  on_agent(robot, now);
  Robot& known = robots_[robot];
  if (!known.requested_at || now - *known.requested_at > kMaxRequestGap) known.requested_since = now;
  known.requested_at = now;
}

bool FleetReception::hears_robots(Time now) const {
  const auto count_since = [&](Duration age) {
    return std::ranges::count_if(
        robots_, [&](const auto& r) { return r.second.report_at && now - *r.second.report_at <= age; });
  };
  const auto heard = count_since(max_silence_);
  return heard > 0 && 2 * heard >= count_since(kForgetAfter);
}

bool FleetReception::hears_agents(const std::vector<RobotId>& robots, Time now) const {
  return std::ranges::all_of(robots, [&](RobotId robot) {
    const auto found = robots_.find(robot);
    return found != robots_.end() && found->second.agent_at &&
           now - *found->second.agent_at <= kMaxAgentSilence;
  });
}

bool FleetReception::hears_vision(Time now) const {
  return vision_at_ && now - *vision_at_ <= kMaxVisionSilence;
}

void FleetReception::clear() {
  robots_.clear();
  served_at_.reset();
  vision_at_.reset();
}

const FleetReception::Robot* FleetReception::find_requesting(RobotId robot, Time now) const {
  const auto found = robots_.find(robot);
  const bool asks = found != robots_.end() && found->second.requested_at &&
                    now - *found->second.requested_at <= kMaxRequestGap;
  return asks ? &found->second : nullptr;
}

Duration FleetReception::request_duration(RobotId robot, Time now) const {
  const Robot* const asking = find_requesting(robot, now);
  return asking ? *asking->requested_at - *asking->requested_since : Duration{0};
}

Duration FleetReception::time_since_first_request(RobotId robot, Time now) const {
  const Robot* const asking = find_requesting(robot, now);
  return asking ? now - *asking->requested_since : Duration{0};
}

void FleetReception::forget_requests() {
  for (auto& [robot, known] : robots_) known.requested_at.reset();
}

}  // namespace sidestep
