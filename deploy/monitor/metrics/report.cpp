// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/metrics/report.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/file/write_file.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

/// Rounds to micrometres or microseconds, for readable reports.
Json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * 1e6) / 1e6;
}
Json rounded(const std::optional<double>& value) { return value ? rounded(*value) : Json(nullptr); }

Json microseconds(Duration duration) { return std::round(to_seconds(duration) * 1e7) / 10; }

Json quantiles(const DurationHistogram& histogram, bool with_max) {
  Json json;
  json["p50"] = microseconds(histogram.quantile(0.5));
  json["p99"] = microseconds(histogram.quantile(0.99));
  if (with_max) json["max"] = microseconds(histogram.max());
  return json;
}

Json audit_json(const AuditTotals& audit) {
  Json json;
  json["violations"] = audit.violations;
  json["by_rule"] = Json::object();
  for (std::size_t i = 0; i < kAuditRules; ++i) {
    if (audit.by_rule[i] > 0) json["by_rule"][audit_rule(static_cast<AuditRule>(i)).name] = audit.by_rule[i];
  }
  json["first"] = Json::array();
  for (const Violation& violation : audit.first)
    json["first"].push_back(Json::parse(to_json_line(violation)));
  json["received"] = audit.received;
  json["missed"] = audit.missed;
  json["invalid"] = audit.invalid;
  json["excused_contacts"] = audit.excused_contacts;
  json["excused_displacements"] = audit.excused_displacements;
  json["compared_pairs"] = audit.compared_pairs;
  json["undecided_pairs"] = audit.undecided_pairs;
  json["max_position_error_m"] = rounded(audit.max_position_error_m);
  json["beyond_tracking_bound"] = audit.beyond_tracking_bound;
  return json;
}

std::string to_text(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.3f} {}", *value, unit) : "none";
}

}  // namespace

std::uint64_t Report::unexcused_contacts() const {
  const std::uint64_t excused = audit ? audit->excused_contacts : 0;
  return contacts > excused ? contacts - excused : 0;
}

std::string Report::failure_reason() const {
  std::string reason;
  const auto add = [&reason](const std::string& part) { reason += (reason.empty() ? "" : ", ") + part; };
  if (!abort_reason.empty()) add(abort_reason);
  if (const auto unexcused = unexcused_contacts(); unexcused > 0) add(fmt::format("{} contacts", unexcused));
  if (crashes_while_moving > 0) add(fmt::format("{} crashes of moving robots", crashes_while_moving));
  if (firmware_violations > 0) add(fmt::format("{} firmware violations", firmware_violations));
  if (audit && audit->violations > 0) {
    add(fmt::format("{} audit violations, the first of rule {}", audit->violations,
                    audit_rule(audit->first.front().rule).name));
  }
  if (must_arrive && arrived < robots) add(fmt::format("{} of {} arrived", arrived, robots));
  return reason;
}

std::string to_json(const Report& r) {
  Json json;
  json["program"] = r.program;
  json["scenario"] = r.scenario;
  json["seed"] = r.seed ? Json(*r.seed) : Json(nullptr);
  json["passed"] = r.failure_reason().empty();
  json["failure"] = r.failure_reason().empty() ? Json(nullptr) : Json(r.failure_reason());
  json["robots"] = r.robots;
  json["arrived"] = r.arrived;
  json["contacts"] = r.contacts;
  json["penetration_m_s"] = rounded(r.penetration_m_s);
  json["min_clearance_m"] = rounded(r.min_clearance_m);
  json["crashes"] = r.crashes;
  json["crashes_while_moving"] = r.crashes_while_moving;
  json["max_crash_speed_mps"] = rounded(r.max_crash_speed_mps);
  json["max_robot_crash_speed_mps"] = rounded(r.max_robot_crash_speed_mps);
  json["makespan_s"] = rounded(r.makespan_s);
  json["mean_arrival_s"] = rounded(r.mean_arrival_s);
  json["straight_line_time_ratio"] = rounded(r.straight_line_time_ratio);
  json["arrival_s"] = Json::object();
  for (const auto& [robot, arrival_s] : r.arrival_s)
    json["arrival_s"][std::to_string(robot)] = rounded(arrival_s);
  json["proposals"] = r.proposals;
  json["grants"] = r.grants;
  json["denials"] = r.denials;
  json["cycles"] = r.cycles;
  json["missed_cycles"] = r.missed_cycles;
  json["route_changes"] = r.route_changes;
  json["route_changes_per_s"] = rounded(r.route_changes_per_s);
  json["invalid_messages"] = r.invalid_messages;
  json["firmware_violations"] = r.firmware_violations;
  json["conflicts"] = r.conflicts;
  json["max_reference_error_m"] = rounded(r.max_reference_error_m);
  json["max_clock_offset_s"] = rounded(r.max_clock_offset_s);
  json["clock_uncertainty_s"] = rounded(r.clock_uncertainty_s);
  json["negotiation_us"] = quantiles(r.negotiation, true);
  json["robot_time_s"] = rounded(r.robot_time_s);
  json["deaths"] = Json::array();
  for (const Death& death : r.deaths) {
    json["deaths"].push_back({{"process", death.process},
                              {"reason", death.reason},
                              {"at_s", rounded(death.at_s)},
                              {"restarted", death.restarted}});
  }
  json["mismatches"] = Json::object();
  for (const auto& [process, differences] : r.mismatches) {
    Json& rules = json["mismatches"][process] = Json::object();
    for (const RuleDifference& rule : differences)
      rules[rule.key] = {{"run", rule.own}, {"process", rule.others}};
  }
  json["audit"] = r.audit ? audit_json(*r.audit) : Json(nullptr);
  Json& wall = json["wall_clock"];
  wall["plan_us"] = quantiles(r.plan, false);
  wall["search_us"] = quantiles(r.search, false);
  wall["duration_s"] = rounded(r.duration_s);
  wall["real_time_factor"] = r.duration_s > 0 ? rounded(r.robot_time_s / r.duration_s) : Json(nullptr);
  if (!r.fast_dds.empty()) {
    wall["fast_dds"] = r.fast_dds;
    wall["startup_s"] = rounded(r.startup_s);
    wall["processes"] = Json::object();
    for (const auto& [name, use] : r.processes) {
      wall["processes"][name] = {{"cpu_s", rounded(use.cpu_s)},
                                 {"max_memory_mb", rounded(use.max_memory_mb)}};
    }
  }
  return json.dump(2) + "\n";
}

std::string summary(const Report& r) {
  const auto us = [](const DurationHistogram& h, double q) { return to_seconds(h.quantile(q)) * 1e6; };
  const double missed =
      r.cycles > 0 ? 100.0 * static_cast<double>(r.missed_cycles) / static_cast<double>(r.cycles) : 0;
  std::string text = fmt::format(
      "{} of {} robots arrived, {} contacts, minimum clearance {}\n"
      "makespan {}, mean arrival {} ({} times the straight-line time), {} route changes per second\n"
      "{} proposals, {} granted, {} denied; {:.2f} % of cycles missed; {} firmware violations\n"
      "negotiation p50 {:.0f} us, p99 {:.0f} us; planning p50 {:.0f} us, p99 {:.0f} us; safety search p50 "
      "{:.0f} us, p99 {:.0f} us\n",
      r.arrived, r.robots, r.contacts, to_text(r.min_clearance_m, "m"), to_text(r.makespan_s, "s"),
      to_text(r.mean_arrival_s, "s"),
      r.straight_line_time_ratio ? fmt::format("{:.2f}", *r.straight_line_time_ratio) : "?",
      r.route_changes_per_s ? fmt::format("{:.1f}", *r.route_changes_per_s) : "?", r.proposals, r.grants,
      r.denials, missed, r.firmware_violations, us(r.negotiation, 0.5), us(r.negotiation, 0.99),
      us(r.plan, 0.5), us(r.plan, 0.99), us(r.search, 0.5), us(r.search, 0.99));
  if (r.crashes > 0) {
    text += fmt::format(
        "{} crashes with opponents, {} of them while the robot moved; maximum closing speed {:.2f} m/s, "
        "maximum "
        "robot share {:.2f} m/s\n",
        r.crashes, r.crashes_while_moving, r.max_crash_speed_mps, r.max_robot_crash_speed_mps);
  }
  for (const auto& [first, second] : r.conflicts)
    text +=
        fmt::format("a cause outside the protocol brought robots {} and {} into conflict\n", first, second);
  if (r.audit) {
    text +=
        fmt::format("audit: {} violations; {} messages received, {} missed; {} pairs of versions compared\n",
                    r.audit->violations, r.audit->received, r.audit->missed, r.audit->compared_pairs);
    for (std::size_t i = 0; i < std::min<std::size_t>(r.audit->first.size(), 5); ++i)
      text += "  " + to_line(r.audit->first[i]) + "\n";
  }
  for (const auto& [process, differences] : r.mismatches) {
    text += fmt::format("{} was refused because it works by other rules: {}\n", process,
                        differences.empty() ? "it did not say which" : describe(differences));
  }
  for (const Death& death : r.deaths) {
    text += fmt::format("{} died at {:.2f} s: {}{}\n", death.process, death.at_s, death.reason,
                        death.restarted ? ", restarted" : "");
  }
  const std::string reason = r.failure_reason();
  return text + (reason.empty() ? "passed\n" : "failed: " + reason + "\n");
}

void write_report(const Report& report, const std::string& path) { write_file(path, to_json(report)); }

std::string default_report_path(const std::string& scenario, std::optional<std::uint64_t> seed) {
  if (seed) return fmt::format("reports/{}-{}.json", scenario, *seed);
  return fmt::format("reports/{}-{:%Y%m%dT%H%M%S}.json", scenario, fmt::localtime(std::time(nullptr)));
}

}  // namespace sidestep
