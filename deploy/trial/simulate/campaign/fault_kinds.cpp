// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/fault_kinds.hpp"

#include <algorithm>

#include "deploy/audit/disturbances.hpp"

namespace sidestep {
namespace {

struct KindOf {
  bool has_end = false;

  std::string operator()(const LinkChange&) const { return "network"; }
  std::string operator()(const Partition&) const { return has_end ? "partition" : "lasting cut"; }
  std::string operator()(const ClockJump&) const { return "process clock step"; }
  std::string operator()(const Pause&) const { return "pause"; }
  std::string operator()(const Kill&) const { return "kill"; }
  std::string operator()(const Start& start) const {
    return start.process.ends_with(" (twin)") ? "twin agent"
           : start.process.ends_with(" (second)")
               ? "second " + start.process.substr(0, start.process.find(' '))
               : "restart";
  }
  std::string operator()(const RobotDisturbance& disturbance) const {
    if (disturbance.kind == msg::DisturbanceKind::DISTURBANCE_CLOCK) return "clock step";
    return std::string(cause_of(disturbance.kind).value_or(""));
  }
  std::string operator()(const Carry&) const { return "carry"; }
  std::string operator()(const Place&) const { return "place"; }
  std::string operator()(const TakeAway&) const { return "take away"; }
  std::string operator()(const StartWithMutatedRule&) const { return "other rules"; }
  std::string operator()(const StartWithOwnRules&) const { return "restart"; }
  std::string operator()(const SendForgery&) const { return "forgery"; }
  std::string operator()(const GiveOrder& give) const {
    switch (give.order.kind) {
      case msg::OrderKind::ORDER_GO:
        return "order to go";
      case msg::OrderKind::ORDER_CANCEL:
        return "cancellation";
      case msg::OrderKind::ORDER_HOLD:
        return give.order.robot == kAllRobots ? "hold of all robots" : "hold";
      case msg::OrderKind::ORDER_RESUME:
        return "resume";
      case msg::OrderKind::ORDER_ZONE:
        return "zone";
      case msg::OrderKind::ORDER_REMOVE_ZONE:
        break;
    }
    return "removal of a zone";
  }
};

}  // namespace

std::set<std::string> fault_kinds(const Scenario& scenario, const FaultPlan& plan) {
  std::set<std::string> kinds;
  for (const TimedFault& timed : plan.faults)
    kinds.insert(std::visit(KindOf{timed.duration.has_value()}, timed.fault));
  if (!plan.clocks.empty()) kinds.insert("clock offsets");
  if (!robots_with(plan, RobotEnd::kClockOutOfBound).empty()) kinds.insert("clock out of bound");
  if (std::ranges::any_of(scenario.robots, [](const RobotSpec& r) { return r.clock_drift_ppm != 0; }))
    kinds.insert("clock drift");
  if (scenario.vision.ghost_probability > 0) kinds.insert("ghost robots");
  if (scenario.vision.ghost_obstacle_probability > 0) kinds.insert("ghost obstacles");
  if (!scenario.opponents.empty()) kinds.insert(scenario.map ? "people in a building" : "opponents");
  if (scenario.laser) kinds.insert("lasers");
  if (!robots_with(plan, RobotEnd::kLifted).empty()) kinds.insert("lifted for good");
  return kinds;
}

}  // namespace sidestep
