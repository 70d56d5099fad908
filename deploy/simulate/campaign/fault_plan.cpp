// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/fault_plan.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>

namespace sidestep {
namespace {

double ms(Duration duration) { return to_seconds(duration) * 1e3; }

/// Describes a fault in words.
class Describe {
 public:
  explicit Describe(const FaultPlan& plan) : plan_(plan) {}

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
    return fmt::format("partition from {} to {} for {:.3f} s", group(partition.from), group(partition.to),
                       to_seconds(partition.duration));
  }
  std::string operator()(const Pause& pause) const {
    return fmt::format("{} paused for {:.3f} s, at most {} messages queued", group(pause.processes),
                       to_seconds(pause.duration), pause.max_queued);
  }
  std::string operator()(const Kill& kill) const { return kill.process + " killed"; }
  std::string operator()(const Start& start) const { return start.process + " started"; }
  std::string operator()(const RobotDisturbance& disturbance) const {
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
      default:
        return fmt::format("firmware of robot {} restarted", disturbance.robot);
    }
  }

 private:
  /// A short name: a whole host by its number, and almost all processes by the exceptions.
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
};

}  // namespace

std::vector<std::string> to_lines(const FaultPlan& plan) {
  std::vector<std::string> lines;
  const bool are_single = std::ranges::all_of(plan.hosts, [](const auto& host) { return host.size() == 1; });
  if (are_single) lines.emplace_back("one host per process");
  for (std::size_t i = 0; i < plan.hosts.size() && !are_single; ++i) {
    lines.push_back(fmt::format("host {}: {}", i + 1, fmt::join(plan.hosts[i], ", ")));
  }
  for (const auto& [process, offset] : plan.clocks) {
    lines.push_back(fmt::format("clock of {}: {:+.4f} ms", process, ms(offset)));
  }
  if (!plan.robots_out_of_clock_bound.empty())
    lines.push_back(fmt::format("robots that must not move because of their clocks: {}",
                                fmt::join(plan.robots_out_of_clock_bound, ", ")));
  for (const TimedFault& timed : plan.faults) {
    lines.push_back(
        fmt::format("{:.3f} s: {}", to_seconds(timed.at), std::visit(Describe(plan), timed.fault)));
  }
  lines.push_back(fmt::format("{:.3f} s: end of all faults", to_seconds(plan.healed_at)));
  return lines;
}

}  // namespace sidestep
