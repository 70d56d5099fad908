// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/report.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "common/file/write_file.hpp"
#include "common/json/json_text.hpp"
#include "deploy/audit/metrics/floor_trace_json.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShown = 5;  // maximum length of a list in a summary

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

Json coverage_json(const AuditTotals& audit) {
  const Coverage& coverage = audit.coverage;
  return {{"share", rounded(coverage.share())},     {"messages", rounded(coverage.messages)},
          {"versions", rounded(coverage.versions)}, {"pairs", rounded(coverage.pairs)},
          {"time", rounded(coverage.time)},         {"reference", rounded(coverage.reference)},
          {"minimum", Coverage::kMinimum},          {"run_s", rounded(audit.run_s)}};
}

Json excused_json(const AuditTotals& audit) {
  Json json = Json::array();
  for (const ExcusedContacts& excused : audit.excused) {
    Json robots = Json::array({excused.first});
    if (excused.second) robots.push_back(*excused.second);
    json.push_back({{"cause", excused.cause}, {"robots", robots}, {"contacts", excused.contacts}});
  }
  return json;
}

Json audit_json(const AuditTotals& audit) {
  Json json;
  json["verdict"] = name_of(audit.verdict());
  json["coverage"] = coverage_json(audit);
  json["reference"] = name_of(audit.reference);
  json["violations"] = audit.violations;
  json["by_rule"] = Json::object();
  for (std::size_t i = 0; i < kAuditRules; ++i) {
    if (audit.by_rule[i] > 0)
      json["by_rule"][rule_info_of(static_cast<AuditRule>(i)).name] = audit.by_rule[i];
  }
  json["first"] = Json::array();
  for (const Violation& violation : audit.first)
    json["first"].push_back(parse_ordered_json(to_json_line(violation)));
  json["received"] = audit.received;
  json["missed"] = audit.missed;
  json["invalid"] = audit.invalid;
  json["excused_contacts"] = audit.excused_contacts;
  json["excused_crashes"] = audit.excused_crashes;
  json["excused"] = excused_json(audit);
  json["excused_time_share"] = rounded(audit.excused_time_share());
  json["excused_displacements"] = audit.excused_displacements;
  json["unidentified_contacts"] = audit.unidentified_contacts;
  json["undecided_contacts"] = audit.undecided_contacts;
  json["undecided_crashes"] = audit.undecided_crashes;
  json["compared_pairs"] = audit.compared_pairs;
  json["undecided_pairs"] = audit.undecided_pairs;
  json["max_position_error_m"] = rounded(audit.max_position_error_m);
  return json;
}

Json ending_json(const EndingRecord& ending) {
  return {{"cause", ending.cause},
          {"duration_s", rounded(ending.duration_s)},
          {"contacts", ending.contacts},
          {"problem", ending.problem.empty() ? Json(nullptr) : Json(ending.problem)}};
}

/// Adds when each violation was detected, which the audit itself does not know.
void add_times(Json& violations, const std::vector<Violation>& first, Time zero) {
  for (std::size_t i = 0; i < first.size(); ++i)
    violations[i]["at_s"] = rounded(to_seconds(first[i].detected - zero));
}

/// The report as text: indented, but each part of the floor and each path on one line.
std::string report_text(const Json& report) {
  std::string text;
  for (const auto& [key, value] : report.items()) {
    text += fmt::format("{}  {}: ", text.empty() ? "" : ",\n", json_text(Json(key)));
    if ((key == "floor" || key == "paths") && !value.empty()) {
      std::string lines;
      for (const auto& [name, part] : value.items())
        lines +=
            fmt::format("{}    {}: {}", lines.empty() ? "" : ",\n", json_text(Json(name)), json_text(part));
      text += "{\n" + lines + "\n  }";
      continue;
    }
    for (const char c : json_text(value, 2)) text += c == '\n' ? "\n  " : std::string(1, c);
  }
  return "{\n" + text + "\n}\n";
}

/// Why the run did not pass.
std::string reason_of(const Report& report) {
  if (report.verdict() == AuditVerdict::kNotJudged && !report.director_deaths.empty())
    return fmt::format("not judged: the process that observed the run died ({}) and was replaced",
                       fmt::join(report.director_deaths, ", "));
  if (report.verdict() == AuditVerdict::kNotJudged && report.ending && !report.ending->problem.empty())
    return "not judged: " + report.ending->problem;
  if (report.verdict() == AuditVerdict::kNotJudged) return "not judged: " + shortfall(*report.audit);
  return report.failure_reason();
}

/// The audit's findings in a few lines.
std::string audit_text(const AuditTotals& audit) {
  std::string text = fmt::format(
      "audit: {}\n"
      "{} violations; {} messages received, {} missed; {} pairs of versions compared; positions and contacts "
      "from: {}\n",
      verdict_line(audit), audit.violations, audit.received, audit.missed, audit.compared_pairs,
      name_of(audit.reference));
  const auto shown = [](const auto& list) { return std::min<std::size_t>(list.size(), kShown); };
  for (std::size_t i = 0; i < shown(audit.first); ++i) text += "  " + to_line(audit.first[i]) + "\n";
  if (audit.excused_contacts > 0) {
    text += fmt::format(
        "{} contacts are excused by disturbances, which excuse {:.2f} % of the time of all pairs\n",
        audit.excused_contacts, 100 * audit.excused_time_share());
  }
  for (std::size_t i = 0; i < shown(audit.excused); ++i) {
    const ExcusedContacts& excused = audit.excused[i];
    text +=
        fmt::format("  {} of robot {} and {}, cause: {}\n", excused.contacts, excused.first,
                    excused.second ? fmt::format("robot {}", *excused.second) : "an obstacle", excused.cause);
  }
  return text;
}

std::string to_text(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.3f} {}", *value, unit) : "none";
}

/// Drops that only faulty, third-party or hostile processes cause, in one line; empty if there are none.
std::string unusual_text(const Report& report) {
  std::string text;
  for (const auto& [process, counts] : report.counters) {
    for (const auto& [reason, count] : counts) {
      if (info_of(reason).is_unusual)
        text += fmt::format("{}{} {} by {}", text.empty() ? "" : ", ", count, info_of(reason).name, process);
    }
  }
  return text.empty() ? text : "refused: " + text + "\n";
}

/// How the run ended, in one line.
std::string ending_text(const EndingRecord& ending) {
  const std::string rest = ending.problem.empty()
                               ? fmt::format("all robots rested after {:.2f} s", ending.duration_s)
                               : fmt::format("{} after {:.2f} s", ending.problem, ending.duration_s);
  return fmt::format("end: {}; {}, with {} contacts meanwhile\n", ending.cause, rest, ending.contacts);
}

/// One line for each epoch after the first one.
std::string epochs_text(const std::vector<EpochRecord>& epochs) {
  std::string text;
  for (std::size_t i = 1; i < epochs.size() && i <= kShown; ++i)
    text += fmt::format("{} began epoch {} at {}: {}\n", epochs[i].coordinator, epochs[i].epoch,
                        to_text(epochs[i].at_s, "s"), epochs[i].reason);
  if (epochs.size() > kShown + 1) text += fmt::format("{} more epochs\n", epochs.size() - kShown - 1);
  return text;
}

}  // namespace

const char* verb_of_end(const std::string& reason) { return reason == "exit code 0" ? "ended" : "died"; }

std::uint64_t Report::unexcused_contacts() const {
  const std::uint64_t excluded =
      audit ? audit->excused_contacts + audit->unidentified_contacts + audit->undecided_contacts : 0;
  return contacts > excluded ? contacts - excluded : 0;
}

std::uint64_t Report::unexcused_crashes() const {
  const std::uint64_t excluded = audit ? audit->excused_crashes + audit->undecided_crashes : 0;
  return crashes_while_moving > excluded ? crashes_while_moving - excluded : 0;
}

AuditVerdict Report::verdict() const {
  if (!failure_reason().empty()) return AuditVerdict::kFailed;
  if (!director_deaths.empty()) return AuditVerdict::kNotJudged;
  if (ending && !ending->problem.empty()) return AuditVerdict::kNotJudged;
  return audit ? audit->verdict() : AuditVerdict::kPassed;
}

std::string Report::failure_reason() const {
  std::string reason;
  const auto add = [&reason](const std::string& part) { reason += (reason.empty() ? "" : ", ") + part; };
  if (!abort_reason.empty()) add(abort_reason);
  if (!recording_failure.empty()) add("recording: " + recording_failure);
  if (const auto unexcused = unexcused_contacts(); unexcused > 0) add(fmt::format("{} contacts", unexcused));
  if (const auto crashes_moving = unexcused_crashes(); crashes_moving > 0)
    add(fmt::format("{} crashes of moving robots with opponents or people", crashes_moving));
  if (firmware_violations > 0) add(fmt::format("{} firmware violations", firmware_violations));
  if (audit && audit->has_failed()) {
    add(fmt::format("{} audit violations, the first of rule {}", audit->violations,
                    rule_info_of(audit->first.front().rule).name));
  }
  if (must_arrive && !arrivals().are_complete())
    add(fmt::format("{} of {} arrived", arrived, arrivals().with_goal()));
  return reason;
}

std::string to_json(const Report& r) {
  Json json;
  json["program"] = r.program;
  json["scenario"] = r.scenario;
  json["seed"] = r.seed ? Json(*r.seed) : Json(nullptr);
  const bool has_passed = r.verdict() == AuditVerdict::kPassed;
  json["passed"] = has_passed;
  json["failure"] = has_passed ? Json(nullptr) : Json(reason_of(r));
  json["robots"] = r.robots;
  json["arrived"] = r.arrived;
  json["without_goal"] = r.without_goal;
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
  json["not_arrived"] = Json::object();
  for (const auto& [robot, why] : r.not_arrived) json["not_arrived"][std::to_string(robot)] = why;
  json["proposals"] = r.proposals;
  json["grants"] = r.grants;
  json["denials"] = r.denials;
  json["cycles"] = r.cycles;
  json["missed_cycles"] = r.missed_cycles;
  json["route_changes"] = r.route_changes;
  json["route_changes_per_s"] = rounded(r.route_changes_per_s);
  json["firmware_violations"] = r.firmware_violations;
  json["conflicts"] = r.conflicts;
  json["quarantined"] = r.quarantined;
  json["displaced"] = r.displaced;
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
  json["director_deaths"] = r.director_deaths;
  json["ending"] = r.ending ? ending_json(*r.ending) : Json(nullptr);
  json["epochs"] = Json::array();
  for (const EpochRecord& epoch : r.epochs) {
    json["epochs"].push_back({{"coordinator", epoch.coordinator},
                              {"epoch", epoch.epoch},
                              {"at_s", rounded(epoch.at_s)},
                              {"reason", epoch.reason}});
  }
  json["mismatches"] = Json::object();
  for (const auto& [process, differences] : r.mismatches) {
    Json& rules = json["mismatches"][process] = Json::object();
    for (const RuleDifference& rule : differences)
      rules[rule.key] = {{"run", rule.own}, {"process", rule.others}};
  }
  json["counters"] = Json::object();
  for (const auto& [process, counts] : r.counters) {
    for (const auto& [reason, count] : counts) json["counters"][process][info_of(reason).name] = count;
  }
  json["audit"] = r.audit ? audit_json(*r.audit) : Json(nullptr);
  if (r.trace) {
    if (r.audit) add_times(json["audit"]["first"], r.audit->first, r.trace->zero);
    add_floor_trace(json, *r.trace);
  } else {
    json["floor"] = json["paths"] = json["incidents"] = nullptr;
  }
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
  return report_text(json);
}

std::string summary(const Report& r) {
  const auto us = [](const DurationHistogram& h, double q) { return to_seconds(h.quantile(q)) * 1e6; };
  const double missed =
      r.cycles > 0 ? 100.0 * static_cast<double>(r.missed_cycles) / static_cast<double>(r.cycles) : 0;
  std::string text = fmt::format(
      "{}, {} contacts {}, minimum clearance {}\n"
      "makespan {}, mean arrival {} ({} times the straight-line time), {} route changes per second\n"
      "{} proposals, {} granted, {} denied; {:.2f} % of cycles missed; {} firmware violations\n"
      "negotiation p50 {:.0f} us, p99 {:.0f} us; planning p50 {:.0f} us, p99 {:.0f} us; safety search p50 "
      "{:.0f} us, p99 {:.0f} us\n",
      arrivals_text(r.arrivals()), r.contacts, kContactMeaning, to_text(r.min_clearance_m, "m"),
      to_text(r.makespan_s, "s"), to_text(r.mean_arrival_s, "s"),
      r.straight_line_time_ratio ? fmt::format("{:.2f}", *r.straight_line_time_ratio) : "?",
      r.route_changes_per_s ? fmt::format("{:.1f}", *r.route_changes_per_s) : "?", r.proposals, r.grants,
      r.denials, missed, r.firmware_violations, us(r.negotiation, 0.5), us(r.negotiation, 0.99),
      us(r.plan, 0.5), us(r.plan, 0.99), us(r.search, 0.5), us(r.search, 0.99));
  if (r.crashes > 0) {
    text += fmt::format(
        "{} crashes: {}, {} of them while the robot moved; maximum closing speed {:.2f} m/s, maximum robot "
        "share {:.2f} m/s\n",
        r.crashes, kCrashMeaning, r.crashes_while_moving, r.max_crash_speed_mps, r.max_robot_crash_speed_mps);
  }
  constexpr std::size_t kShownRobots = 10;
  std::size_t shown = 0;
  for (const auto& [robot, why] : r.not_arrived) {
    if (++shown <= kShownRobots) text += fmt::format("robot {} has not arrived: {}\n", robot, why);
  }
  if (shown > kShownRobots) text += fmt::format("... and {} others\n", shown - kShownRobots);
  for (const RobotId robot : r.quarantined)
    text += fmt::format("robot {} was quarantined: it executed a version that it was never granted\n", robot);
  for (const RobotId robot : r.displaced)
    text += fmt::format("robot {} was displaced: vision saw it where none of its versions led\n", robot);
  for (const auto& [first, second] : r.conflicts)
    text +=
        fmt::format("a cause outside the protocol brought robots {} and {} into conflict\n", first, second);
  if (r.audit) text += audit_text(*r.audit);
  for (const auto& [process, differences] : r.mismatches) {
    text += fmt::format("{} was refused because it has different rules: {}\n", process,
                        differences.empty() ? "it did not say which" : describe(differences));
  }
  if (r.ending) text += ending_text(*r.ending);
  for (const Death& death : r.deaths) {
    text += fmt::format("{} {} at {:.2f} s: {}{}\n", death.process, verb_of_end(death.reason), death.at_s,
                        death.reason, death.restarted ? ", restarted" : "");
  }
  text += unusual_text(r);
  text += epochs_text(r.epochs);
  switch (r.verdict()) {
    case AuditVerdict::kPassed:
      return text + "passed\n";
    case AuditVerdict::kFailed:
      return text + "failed: " + reason_of(r) + "\n";
    case AuditVerdict::kNotJudged:
      break;
  }
  return text + reason_of(r) + "\n";
}

void write_report(const Report& report, const std::string& path) { write_file(path, to_json(report)); }

std::string try_write_report(const Report& report, const std::string& path) {
  return try_write_file(path, to_json(report));
}

std::string default_report_path(const std::string& scenario, std::optional<std::uint64_t> seed) {
  if (seed) return fmt::format("reports/{}-{}.json", scenario, *seed);
  return fmt::format("reports/{}-{:%Y%m%dT%H%M%S}.json", scenario, fmt::localtime(std::time(nullptr)));
}

}  // namespace sidestep
