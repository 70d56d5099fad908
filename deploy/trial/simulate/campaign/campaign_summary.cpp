// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/campaign_summary.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/json/json_text.hpp"
#include "common/version/version.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/trial/simulate/campaign/trial_result.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kShown = 5;

double share(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

/// The probability of at most this many events if `mean` are expected.
double poisson_cdf(std::uint64_t events, double mean) {
  double term = std::exp(-mean), total = term;
  for (std::uint64_t i = 1; i <= events; ++i) total += term *= mean / static_cast<double>(i);
  return total;
}

}  // namespace

double upper_bound_95(std::uint64_t events, double time) {
  if (time <= 0) return std::numeric_limits<double>::infinity();
  double low = 0, high = 10 + 3 * static_cast<double>(events);
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (poisson_cdf(events, middle) > 0.05 ? low : high) = middle;
  }
  return high / time;
}

std::uint64_t CampaignSummary::sum(std::uint64_t TrialResult::*count) const {
  std::uint64_t total = 0;
  for (const auto& [seed, result] : results_) total += result.*count;
  return total;
}

std::uint64_t CampaignSummary::failed() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(results_, [](const auto& entry) { return !entry.second.failures.empty(); }));
}

double CampaignSummary::robot_hours() const {
  double total_s = 0;
  for (const auto& [seed, result] : results_) total_s += result.robot_s;
  return total_s / 3600;
}

std::map<std::string, std::uint64_t> CampaignSummary::excused_by_cause() const {
  std::map<std::string, std::uint64_t> total;
  for (const auto& [seed, result] : results_) {
    for (const auto& [cause, contacts] : result.excused_by_cause) total[cause] += contacts;
  }
  return total;
}

std::map<std::string, std::uint64_t> CampaignSummary::trials_by_fault() const {
  std::map<std::string, std::uint64_t> total;
  for (const auto& [seed, result] : results_) {
    for (const std::string& kind : result.fault_kinds) ++total[kind];
  }
  return total;
}

CampaignSummary::Audited CampaignSummary::audited() const {
  Audited total;
  for (const auto& [seed, result] : results_) {
    if (result.is_audited)
      total.violations += result.audit_violations;
    else
      ++total.skipped_trials, total.skipped_violations += result.audit_violations;
  }
  return total;
}

double CampaignSummary::excused_time_share() const {
  double pair_s = 0, excused_pair_s = 0;
  for (const auto& [seed, result] : results_) {
    pair_s += result.pair_s;
    excused_pair_s += result.excused_pair_s;
  }
  return pair_s > 0 ? excused_pair_s / pair_s : 0;
}

template <typename Value>
std::string CampaignSummary::extremes(Value value, bool are_largest) const {
  const double sign = are_largest ? -1 : 1;
  std::vector<std::pair<double, std::uint64_t>> order;
  for (const auto& [seed, result] : results_) order.emplace_back(sign * value(result), seed);
  std::ranges::sort(order);
  std::string text;
  for (std::size_t i = 0; i < std::min(order.size(), kShown); ++i) {
    text +=
        fmt::format("{}seed {} ({:.3g})", i > 0 ? ", " : "", order[i].second, sign * order[i].first + 0.0);
  }
  return text;
}

std::string CampaignSummary::text() const {
  double distance_m = 0, wall_s = 0;
  for (const auto& [seed, result] : results_) {
    distance_m += result.distance_m;
    wall_s += result.wall_s;
  }
  const double hours = robot_hours();
  const Audited audit = audited();
  std::string text = fmt::format(
      "{} seeds, {} failed; {:.2f} robot-hours, {:.1f} km driven; {} contacts {}, {} audit violations, {} "
      "firmware violations\n",
      seeds(), failed(), hours, distance_m / 1000, contacts(), kContactMeaning, audit.violations,
      sum(&TrialResult::firmware_violations));
  if (audit.skipped_trials > 0) {
    text += fmt::format(
        "{} trials are not judged by the audit, because a process accepted a second simulator; it reported "
        "{} "
        "violations there\n",
        audit.skipped_trials, audit.skipped_violations);
  }
  text += fmt::format("{} excused contacts", sum(&TrialResult::excused_contacts));
  for (const auto& [cause, excused] : excused_by_cause())
    text += fmt::format(", {} of cause {}", excused, cause);
  text += fmt::format("; a contact would be excused in {:.2f} % of the time of all pairs\n",
                      100 * excused_time_share());
  std::vector<std::string> kinds;
  for (const auto& [kind, trials] : trials_by_fault()) kinds.push_back(fmt::format("{} {}", kind, trials));
  text += fmt::format("trials with each kind of fault: {}\n",
                      kinds.empty() ? "none" : fmt::format("{}", fmt::join(kinds, ", ")));
  text += fmt::format("with 95 % confidence at most {:.3g} contacts per robot-hour under these faults\n",
                      upper_bound_95(contacts(), hours));
  text += fmt::format("{} proposals, {:.2f} % denied; {:.0f} robot-seconds per second and core\n",
                      sum(&TrialResult::proposals),
                      100 * share(sum(&TrialResult::denials), sum(&TrialResult::proposals)),
                      wall_s > 0 ? hours * 3600 / wall_s : 0);
  text += "shortest distance, in metres per robot and minute: " +
          extremes([](const TrialResult& r) { return r.robot_s > 0 ? 60 * r.distance_m / r.robot_s : 0; },
                   false) +
          "\n";
  text += "largest share of denied proposals: " +
          extremes([](const TrialResult& r) { return share(r.denials, r.proposals); }, true) + "\n";
  text += "largest share of stationary robots at the end: " +
          extremes([](const TrialResult& r) { return r.robots > 0 ? double(r.stationary) / r.robots : 0; },
                   true) +
          "\n";
  text += "smallest clearance, in metres: " +
          extremes([](const TrialResult& r) { return r.min_clearance_m; }, false) + "\n";
  return text;
}

std::string CampaignSummary::json() const {
  Json json;
  json["commit"] = kBuildCommit;
  json["seeds"] = seeds();
  json["failed"] = failed();
  json["robot_hours"] = robot_hours();
  json["contacts"] = contacts();
  json["excused_contacts"] = sum(&TrialResult::excused_contacts);
  json["excused_by_cause"] = excused_by_cause();
  json["trials_by_fault"] = trials_by_fault();
  json["excused_time_share"] = excused_time_share();
  json["audit_violations"] = audited().violations;
  json["unaudited_trials"] = audited().skipped_trials;
  json["unaudited_violations"] = audited().skipped_violations;
  json["firmware_violations"] = sum(&TrialResult::firmware_violations);
  json["contacts_per_robot_hour_95"] = upper_bound_95(contacts(), robot_hours());
  json["trials"] = Json::array();
  for (const auto& [seed, result] : results_) json["trials"].push_back(to_json(result));
  return json_text(json, 1) + "\n";
}

}  // namespace sidestep
