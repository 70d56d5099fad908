// SPDX-License-Identifier: Apache-2.0
// Summaries of the collected metrics: progress rows and the report.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "common/messaging/blockage_text.hpp"
#include "common/messaging/histogram_codec.hpp"
#include "common/protocol/agent_state_text.hpp"
#include "common/protocol/process_names.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"
#include "deploy/audit/metrics/straight_line_time.hpp"

namespace sidestep {
namespace {

DurationHistogram sum(const std::vector<msg::AgentStatus>& incarnations,
                      const msg::DurationCounts& (msg::AgentStatus::*counts)() const) {
  DurationHistogram total;
  for (const auto& latest : incarnations) total.merge(decode((latest.*counts)()));
  return total;
}

std::uint64_t sum(const std::vector<msg::AgentStatus>& incarnations,
                  std::uint64_t (msg::AgentStatus::*count)() const) {
  std::uint64_t total = 0;
  for (const auto& latest : incarnations) total += (latest.*count)();
  return total;
}

}  // namespace

std::vector<RobotSighting> RunMetrics::sightings() const {
  std::vector<RobotSighting> result;
  for (const RobotRecord& robot : robots_) {
    const bool is_lifted = robot.status() && robot.status()->agent_state() == msg::AgentState::AGENT_ABSENT;
    if (robot.sighting && !is_lifted) result.push_back(*robot.sighting);
  }
  return result;
}

std::vector<RobotProgress> RunMetrics::progress() const {
  std::vector<RobotProgress> rows;
  for (const RobotRecord& robot : robots_) {
    RobotProgress row;
    row.robot = robot.spec->id;
    row.team = robot.spec->team;
    if (robot.status()) row.agent_state = robot.status()->agent_state();
    row.arrived = has_arrived(robot);
    row.is_without_goal = is_without_goal(robot);
    row.is_done = is_done(robot);
    row.distance_to_go_m = distance_to_go_m(robot);
    row.speed_mps = robot.speed_mps;
    row.grants = sum(robot.incarnations, &msg::AgentStatus::grants);
    row.denials = sum(robot.incarnations, &msg::AgentStatus::denials);
    const DurationHistogram negotiation = sum(robot.incarnations, &msg::AgentStatus::negotiation);
    row.negotiation_p50 = negotiation.quantile(0.5);
    row.negotiation_p99 = negotiation.quantile(0.99);
    rows.push_back(row);
  }
  return rows;
}

void RunMetrics::add_ground_truth(Report& report) const {
  for (const auto& latest : simulators_) {
    report.contacts += latest.contacts();
    report.penetration_m_s += latest.penetration_m_s();
    report.firmware_violations += latest.firmware_violations();
    report.crashes += latest.crashes();
    report.crashes_while_moving += latest.crashes_while_moving();
    report.max_crash_speed_mps = std::max(report.max_crash_speed_mps, latest.max_crash_speed_mps());
    report.max_robot_crash_speed_mps =
        std::max(report.max_robot_crash_speed_mps, latest.max_robot_crash_speed_mps());
    if (std::isfinite(latest.min_clearance_m())) {
      report.min_clearance_m =
          std::min(report.min_clearance_m.value_or(latest.min_clearance_m()), latest.min_clearance_m());
    }
  }
  report.max_reference_error_m = max_reference_error_m_;
  if (granting_since_ && seen_at())
    report.robot_time_s = std::max(0.0, to_seconds(*seen_at() - *granting_since_));
}

std::string RunMetrics::reason_not_arrived(const RobotRecord& robot) const {
  if (!robot.status()) return "its agent has sent no status";
  const bool awaits_orders = robot.spec->goals.empty();
  const msg::AgentState state = robot.status()->agent_state();
  if (const char* const text = hindrance_text(state)) return text;
  if (state == msg::AgentState::AGENT_WITHOUT_ORDER)
    return awaits_orders ? "it has no order, but was not seen at rest" : "its order was cancelled";
  if (state == msg::AgentState::AGENT_ARRIVED && awaits_orders)
    return "it was not seen at rest, although its agent reports arrival";
  if (state == msg::AgentState::AGENT_ARRIVED)
    return fmt::format("it is {:.2f} m from its last goal, although its agent reports arrival",
                       distance_to_go_m(robot));
  if (robot.blockage) return to_text(*robot.blockage);
  // Only the agent knows the goals that clients have given.
  if (awaits_orders)
    return fmt::format("it was under way, {:.2f} m from its goal", robot.status()->distance_to_go_m());
  return fmt::format("it was under way, {:.2f} m from its last goal", distance_to_go_m(robot));
}

void RunMetrics::add_arrivals(Report& report) const {
  report.arrived = arrived();
  report.without_goal = without_goal();
  double latest_s = 0, total_s = 0;
  std::vector<std::optional<double>> arrivals_s;  // in the order of the scenario's robots
  for (const RobotRecord& robot : robots_) {
    auto& arrival_s = report.arrival_s[robot.spec->id];
    if (!is_done(robot)) report.not_arrived[robot.spec->id] = reason_not_arrived(robot);
    if (has_arrived(robot) && granting_since_) {
      arrival_s = std::max(0.0, to_seconds(*robot.settled_since - *granting_since_));
      latest_s = std::max(latest_s, *arrival_s);
      total_s += *arrival_s;
    }
    arrivals_s.push_back(arrival_s);
  }
  if (report.arrived > 0 && granting_since_) report.mean_arrival_s = total_s / report.arrived;
  if (report.arrived > 0 && report.arrivals().are_complete() && granting_since_) report.makespan_s = latest_s;
  report.straight_line_time_ratio = straight_line_time_ratio(scenario_.robots, arrivals_s, scenario_.limits);
}

void RunMetrics::add_agents(Report& report) const {
  for (const RobotRecord& robot : robots_) {
    report.proposals += sum(robot.incarnations, &msg::AgentStatus::proposals);
    report.grants += sum(robot.incarnations, &msg::AgentStatus::grants);
    report.denials += sum(robot.incarnations, &msg::AgentStatus::denials);
    report.cycles += sum(robot.incarnations, &msg::AgentStatus::cycles);
    report.missed_cycles += sum(robot.incarnations, &msg::AgentStatus::missed_cycles);
    report.route_changes += sum(robot.incarnations, &msg::AgentStatus::route_changes);
    report.negotiation.merge(sum(robot.incarnations, &msg::AgentStatus::negotiation));
    report.plan.merge(sum(robot.incarnations, &msg::AgentStatus::plan));
    report.search.merge(sum(robot.incarnations, &msg::AgentStatus::search));
  }
  const double planned_s = static_cast<double>(report.cycles) * to_seconds(scenario_.cycle);
  if (planned_s > 0) report.route_changes_per_s = static_cast<double>(report.route_changes) / planned_s;
}

void RunMetrics::add_clocks(Report& report) const {
  for (const RobotRecord& robot : robots_) {
    const msg::AgentStatus* status = robot.status();
    if (!status) continue;
    const double offset_s = std::abs(status->clock_offset_s());
    // A NaN fails both comparisons.
    if (!(status->clock_uncertainty_s() >= 0) || !(offset_s >= report.max_clock_offset_s.value_or(0)))
      continue;
    report.max_clock_offset_s = offset_s;
    report.clock_uncertainty_s = status->clock_uncertainty_s();
  }
}

void RunMetrics::add_counters(Report& report) const {
  const auto add = [&](const std::string& process, std::size_t reason, std::uint64_t count) {
    if (count > 0) report.counters[process][static_cast<DropReason>(reason)] += count;
  };
  const auto add_incarnation = [&](const std::string& process, const IncarnationCounters& latest) {
    for (std::size_t i = 0; i < kDropReasonCount; ++i) add(process, i, latest.counts[i]);
  };
  for (const auto& [process, counters] : counters_) {
    add_incarnation(process_name(process), counters.earlier);
    for (const IncarnationCounters& latest : counters.incarnations)
      add_incarnation(process_name(process), latest);
  }
  DropCounters own;
  own.count(DropReason::kUnusedByMonitor, std::nullopt, dropped_messages_);
  if (bus_) bus_->count_drops(own);
  for (const DropCount& one : own.counts()) add("monitor", static_cast<std::size_t>(one.reason), one.count);
}

Report RunMetrics::report() const {
  Report report;
  report.scenario = scenario_.name;
  report.robots = static_cast<int>(robots_.size());
  add_ground_truth(report);
  add_arrivals(report);
  add_agents(report);
  add_clocks(report);
  add_counters(report);
  report.deaths = deaths_;
  report.epochs = epochs_;
  for (EpochRecord& epoch : report.epochs) {
    if (granting_since_) epoch.at_s = to_seconds(epoch.begun_at - *granting_since_);
  }
  report.mismatches = mismatches_;
  report.conflicts = conflicts_;
  report.quarantined = quarantined_;
  report.displaced = displaced_;
  if (auditor_) report.audit = auditor_->totals();
  return report;
}

}  // namespace sidestep
