// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/metrics/report.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

/// To the micrometre or microsecond, so that reports stay readable.
Json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * 1e6) / 1e6;
}
Json rounded(const std::optional<double>& value) { return value ? rounded(*value) : Json(nullptr); }

Json microseconds(Duration duration) { return std::round(to_seconds(duration) * 1e7) / 10; }

Json quantiles(const DurationHistogram& histogram, bool with_largest) {
  Json json;
  json["p50"] = microseconds(histogram.quantile(0.5));
  json["p99"] = microseconds(histogram.quantile(0.99));
  if (with_largest) json["max"] = microseconds(histogram.largest());
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
  json["heard"] = audit.heard;
  json["missed"] = audit.missed;
  json["invalid"] = audit.invalid;
  json["contacts_by_hand"] = audit.contacts_by_hand;
  json["places_by_hand"] = audit.places_by_hand;
  json["pairs"] = audit.pairs;
  json["unjudged"] = audit.unjudged;
  json["farthest_from_reference_m"] = rounded(audit.farthest_m);
  json["beyond_tracking_bound"] = audit.beyond;
  return json;
}

std::string shown(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.3f} {}", *value, unit) : "none";
}

}  // namespace

std::uint64_t Report::contacts_of_its_own() const {
  const std::uint64_t by_hand = audit ? audit->contacts_by_hand : 0;
  return contacts > by_hand ? contacts - by_hand : 0;
}

std::string Report::verdict() const {
  std::string why;
  const auto add = [&why](const std::string& part) { why += (why.empty() ? "" : ", ") + part; };
  if (!failure.empty()) add(failure);
  if (const auto touched = contacts_of_its_own(); touched > 0) add(fmt::format("{} contacts", touched));
  if (moving_crashes > 0) add(fmt::format("{} crashes of moving robots", moving_crashes));
  if (firmware_violations > 0) add(fmt::format("{} firmware violations", firmware_violations));
  if (audit && audit->violations > 0) {
    add(fmt::format("{} violations found by the audit, first of {}", audit->violations,
                    audit_rule(audit->first.front().rule).name));
  }
  if (must_arrive && arrived < robots) add(fmt::format("{} of {} arrived", arrived, robots));
  return why;
}

std::string to_json(const Report& r) {
  Json json;
  json["program"] = r.program;
  json["scenario"] = r.scenario;
  json["seed"] = r.seed ? Json(*r.seed) : Json(nullptr);
  json["passed"] = r.verdict().empty();
  json["failure"] = r.verdict().empty() ? Json(nullptr) : Json(r.verdict());
  json["robots"] = r.robots;
  json["arrived"] = r.arrived;
  json["contacts"] = r.contacts;
  json["penetration_m_s"] = rounded(r.penetration_m_s);
  json["min_clearance_m"] = rounded(r.min_clearance_m);
  json["crashes"] = r.crashes;
  json["moving_crashes"] = r.moving_crashes;
  json["crash_speed_mps"] = rounded(r.crash_speed_mps);
  json["robot_crash_speed_mps"] = rounded(r.robot_crash_speed_mps);
  json["makespan_s"] = rounded(r.makespan_s);
  json["mean_arrival_s"] = rounded(r.mean_arrival_s);
  json["arrival_over_straight"] = rounded(r.arrival_over_straight);
  json["arrival_s"] = Json::object();
  for (const auto& [robot, arrival_s] : r.arrival_s)
    json["arrival_s"][std::to_string(robot)] = rounded(arrival_s);
  json["proposals"] = r.proposals;
  json["grants"] = r.grants;
  json["denials"] = r.denials;
  json["cycles"] = r.cycles;
  json["missed_cycles"] = r.missed_cycles;
  json["plan_changes"] = r.plan_changes;
  json["plan_changes_per_s"] = rounded(r.plan_changes_per_s);
  json["invalid_messages"] = r.invalid_messages;
  json["firmware_violations"] = r.firmware_violations;
  json["conflicts"] = r.conflicts;
  json["max_reference_error_m"] = rounded(r.max_reference_error_m);
  json["clock_offset_max_s"] = rounded(r.clock_offset_max_s);
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
  json["audit"] = r.audit ? audit_json(*r.audit) : Json(nullptr);
  Json& wall = json["wall_clock"];
  wall["plan_us"] = quantiles(r.plan, false);
  wall["search_us"] = quantiles(r.search, false);
  wall["duration_s"] = rounded(r.duration_s);
  wall["real_time_factor"] = r.duration_s > 0 ? rounded(r.robot_time_s / r.duration_s) : Json(nullptr);
  return json.dump(2) + "\n";
}

std::string summary(const Report& r) {
  const auto us = [](const DurationHistogram& h, double q) { return to_seconds(h.quantile(q)) * 1e6; };
  const double missed =
      r.cycles > 0 ? 100.0 * static_cast<double>(r.missed_cycles) / static_cast<double>(r.cycles) : 0;
  std::string text = fmt::format(
      "{} of {} arrived, {} contacts, least clearance {}\n"
      "makespan {}, mean arrival {} ({} times the straight line alone), {} changes of plan a second\n"
      "{} proposals, {} granted, {} denied; {:.2f} % of cycles missed; firmware violations {}\n"
      "negotiation p50 {:.0f} us, p99 {:.0f} us; planning p50 {:.0f} us, p99 {:.0f} us; search p50 {:.0f} "
      "us, p99 {:.0f} "
      "us\n",
      r.arrived, r.robots, r.contacts, shown(r.min_clearance_m, "m"), shown(r.makespan_s, "s"),
      shown(r.mean_arrival_s, "s"),
      r.arrival_over_straight ? fmt::format("{:.2f}", *r.arrival_over_straight) : "?",
      r.plan_changes_per_s ? fmt::format("{:.1f}", *r.plan_changes_per_s) : "?", r.proposals, r.grants,
      r.denials, missed, r.firmware_violations, us(r.negotiation, 0.5), us(r.negotiation, 0.99),
      us(r.plan, 0.5), us(r.plan, 0.99), us(r.search, 0.5), us(r.search, 0.99));
  if (r.crashes > 0) {
    text += fmt::format(
        "{} crashes with opponents, {} of them moving; fastest {:.2f} m/s, of which the robot {:.2f} m/s\n",
        r.crashes, r.moving_crashes, r.crash_speed_mps, r.robot_crash_speed_mps);
  }
  for (const auto& [first, second] : r.conflicts)
    text += fmt::format("robots {} and {} were brought too near to each other\n", first, second);
  if (r.audit) {
    text += fmt::format("audit: {} violations in {} messages, {} missed; {} pairs of versions compared\n",
                        r.audit->violations, r.audit->heard, r.audit->missed, r.audit->pairs);
    for (std::size_t i = 0; i < std::min<std::size_t>(r.audit->first.size(), 5); ++i)
      text += "  " + to_line(r.audit->first[i]) + "\n";
  }
  for (const Death& death : r.deaths) {
    text += fmt::format("{} died at {:.2f} s: {}{}\n", death.process, death.at_s, death.reason,
                        death.restarted ? ", restarted" : "");
  }
  const std::string why = r.verdict();
  return text + (why.empty() ? "passed\n" : "failed: " + why + "\n");
}

void write_report(const Report& report, const std::string& path) { write_file(path, to_json(report)); }

void write_file(const std::string& path, const std::string& text) {
  const auto folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  std::ofstream file(path);
  file << text << std::flush;
  if (!file) throw std::runtime_error(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
}

std::string default_report_path(const std::string& scenario, std::optional<std::uint64_t> seed) {
  if (seed) return fmt::format("reports/{}-{}.json", scenario, *seed);
  return fmt::format("reports/{}-{:%Y%m%dT%H%M%S}.json", scenario, fmt::localtime(std::time(nullptr)));
}

}  // namespace sidestep
