// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/fault_plan.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>

#include "common/protocol/client_text.hpp"
#include "deploy/audit/disturbances.hpp"
#include "deploy/trial/simulate/campaign/forger.hpp"
#include "deploy/trial/simulate/campaign/rule_mutations.hpp"

namespace sidestep {
namespace {

double ms(Duration duration) { return to_seconds(duration) * 1e3; }

std::string to_text(const RobotDisturbance& disturbance) {
  const double duration_s = to_seconds(disturbance.duration);
  switch (disturbance.kind) {
    case msg::DisturbanceKind::DISTURBANCE_PUSH:
      return fmt::format("robot {} pushed by ({:.3f}, {:.3f}) m/s", disturbance.robot,
                         disturbance.push_mps.x(), disturbance.push_mps.y());
    case msg::DisturbanceKind::DISTURBANCE_SLIP:
      return fmt::format("robot {} slips for {:.3f} s, grip {:.2f}", disturbance.robot, duration_s,
                         disturbance.grip);
    case msg::DisturbanceKind::DISTURBANCE_BLOCK:
      return fmt::format("a wheel of robot {} blocked for {:.3f} s, along {:.2f} rad", disturbance.robot,
                         duration_s, disturbance.heading_rad);
    case msg::DisturbanceKind::DISTURBANCE_REBOOT:
      return fmt::format("firmware of robot {} restarted", disturbance.robot);
    case msg::DisturbanceKind::DISTURBANCE_FORGET_POSE:
      return fmt::format("robot {} forgets its pose", disturbance.robot);
    case msg::DisturbanceKind::DISTURBANCE_CLOCK:
      return fmt::format("clock of robot {} set to {:+.4f} ms", disturbance.robot,
                         ms(disturbance.clock_offset));
    case msg::DisturbanceKind::DISTURBANCE_SEEN_BESIDE:
      return fmt::format("robot {} seen ({:.4f}, {:.4f}) m beside its place for {:.3f} s", disturbance.robot,
                         disturbance.place_m.x(), disturbance.place_m.y(), duration_s);
    case msg::DisturbanceKind::DISTURBANCE_SEEN_AS:
      return fmt::format("robots {} and {} confused by vision for {:.3f} s", disturbance.robot,
                         disturbance.other_robot, duration_s);
    case msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN:
      return fmt::format("robot {} seen frozen at its place for {:.3f} s", disturbance.robot, duration_s);
    default:
      return fmt::format("robot {}: {}", disturbance.robot, cause_of(disturbance.kind).value_or(""));
  }
}

std::string_view to_text(RobotEnd end) {
  switch (end) {
    case RobotEnd::kClockOutOfBound:
      return "clock out of bound throughout";
    case RobotEnd::kClockLeftBound:
      return "clock far out of bound at the end";
    case RobotEnd::kClockBeyondBound:
      return "clock slightly out of bound at the end";
    case RobotEnd::kLifted:
      return "off the floor at the end";
    case RobotEnd::kTakenAway:
      return "taken away without power";
  }
  return "";
}

std::string to_text(const Order& order) {
  const std::string robot = order.robot == kAllRobots ? "all robots" : fmt::format("robot {}", order.robot);
  const std::string client = client_phrase(order.client, order.client_name);
  switch (order.kind) {
    case msg::OrderKind::ORDER_GO:
      return fmt::format("{} sends {} to ({:.3f}, {:.3f}) m", client, robot,
                         order.goals.front().position_m.x(), order.goals.front().position_m.y());
    case msg::OrderKind::ORDER_CANCEL:
      return fmt::format("{} cancels its order to {}", client, robot);
    case msg::OrderKind::ORDER_HOLD:
      return fmt::format("{} holds {}", client, robot);
    case msg::OrderKind::ORDER_RESUME:
      return fmt::format("{} resumes {}", client, robot);
    case msg::OrderKind::ORDER_ZONE:
      return fmt::format("{} draws zone {} around ({:.3f}, {:.3f}) m", client, order.zone_number,
                         order.zone.corners_m.front().x(), order.zone.corners_m.front().y());
    case msg::OrderKind::ORDER_REMOVE_ZONE:
      break;
  }
  return fmt::format("{} removes zone {}", client, order.zone_number);
}

/// Describes a fault in words.
class Describe {
 public:
  Describe(const FaultPlan& plan, std::optional<Duration> duration) : plan_(plan), duration_(duration) {}

  std::string operator()(const LinkChange& change) const {
    const LinkQuality& q = change.quality;
    return fmt::format(
        "links between hosts, from {} to {}: delay {:.1f} to {:.1f} ms (mean {:.1f}), loss {:.1f} % (mean "
        "burst "
        "{:.1f}), duplicates {:.1f} %",
        group(change.from), group(change.to), ms(q.delay_min), ms(q.delay_max), ms(q.delay_mean),
        100 * q.loss, q.mean_burst, 100 * q.duplicate);
  }
  std::string operator()(const Partition& partition) const {
    const std::string from = group(partition.from), to = group(partition.to);
    if (!duration_) return fmt::format("links from {} to {} cut permanently", from, to);
    return fmt::format("partition from {} to {} for {:.3f} s", from, to, to_seconds(*duration_));
  }
  std::string operator()(const ClockJump& jump) const {
    return fmt::format("clock of {} set to {:+.4f} ms", jump.process, ms(jump.offset));
  }
  std::string operator()(const Pause& pause) const {
    return fmt::format("{} paused for {:.3f} s, at most {} messages queued", group(pause.processes),
                       to_seconds(duration_.value()), pause.max_queued);
  }
  std::string operator()(const Kill& kill) const { return kill.process + " killed"; }
  std::string operator()(const Start& start) const { return start.process + " started"; }
  std::string operator()(const RobotDisturbance& disturbance) const { return to_text(disturbance); }
  std::string operator()(const Carry& carry) const {
    return fmt::format("robot {} carried to {} at {:.2f} m/s", carry.robot, place(carry.place_m),
                       carry.speed_mps);
  }
  std::string operator()(const Place& request) const {
    std::vector<std::string> places;
    for (const Vec2& place_m : request.places_m) places.push_back(place(place_m));
    return fmt::format("robot {} to be placed at {}, heading {:.2f} rad", request.robot,
                       fmt::join(places, " or "), request.heading_rad);
  }
  std::string operator()(const TakeAway& take) const {
    return fmt::format("robot {} taken away without power", take.robot);
  }
  std::string operator()(const StartWithMutatedRule& start) const {
    return fmt::format("{} restarted with a different {}", start.process, rule_mutations()[start.rule].key);
  }
  std::string operator()(const StartWithOwnRules& start) const {
    return start.process + " restarted with the correct scenario";
  }
  std::string operator()(const GiveOrder& give) const { return to_text(give.order); }
  std::string operator()(const SendForgery& send) const {
    return fmt::format("forged message about robot {}: {}", send.victim, forgeries()[send.forgery].name);
  }

 private:
  static std::string place(const Vec2& place_m) {
    return fmt::format("({:.3f}, {:.3f}) m", place_m.x(), place_m.y());
  }
  /// A short name for a group of processes: a whole host by its number, almost all processes by the
  /// exceptions.
  std::string group(const ProcessNames& names) const {
    ProcessNames others;
    for (std::size_t i = 0; i < plan_.hosts.size(); ++i) {
      const ProcessNames& host = plan_.hosts[i];
      if (host.size() > 1 && std::ranges::is_permutation(host, names)) return fmt::format("host {}", i + 1);
      std::ranges::copy_if(host, std::back_inserter(others),
                           [&](const auto& name) { return std::ranges::find(names, name) == names.end(); });
    }
    if (others.empty()) return "all";
    if (others.size() < names.size()) return "all except " + group(others);
    return fmt::format("{}", fmt::join(names, ", "));
  }

  const FaultPlan& plan_;
  std::optional<Duration> duration_;
};

}  // namespace

std::vector<RobotId> robots_with(const FaultPlan& plan, RobotEnd end) {
  std::vector<RobotId> robots;
  for (const auto& [robot, robot_end] : plan.ends) {
    if (robot_end == end) robots.push_back(robot);
  }
  return robots;
}

std::vector<std::string> to_lines(const FaultPlan& plan) {
  std::vector<std::string> lines;
  const bool are_single = std::ranges::all_of(plan.hosts, [](const auto& host) { return host.size() == 1; });
  if (are_single) lines.emplace_back("one host per process");
  for (std::size_t i = 0; i < plan.hosts.size() && !are_single; ++i) {
    lines.push_back(fmt::format("host {}: {}", i + 1, fmt::join(plan.hosts[i], ", ")));
  }
  for (const auto& [process, clock] : plan.clocks)
    lines.push_back(fmt::format("clock of {}: {:+.4f} ms, drift {:+.1f} ppm", process, ms(clock.offset),
                                clock.drift_ppm));
  for (const auto& [robot, end] : plan.ends)
    lines.push_back(fmt::format("robot {}: {}", robot, to_text(end)));
  for (const TimedFault& timed : plan.faults) {
    lines.push_back(fmt::format("{:.3f} s: {}", to_seconds(timed.at),
                                std::visit(Describe(plan, timed.duration), timed.fault)));
  }
  lines.push_back(fmt::format("{:.3f} s: end of all faults", to_seconds(plan.healed_at)));
  return lines;
}

}  // namespace sidestep
