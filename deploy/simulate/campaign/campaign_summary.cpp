// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/campaign_summary.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "deploy/simulate/campaign/commit.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kShown = 5;

double share(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

/// The probability of at most so many events where `mean` are expected.
double poisson(std::uint64_t events, double mean) {
  double term = std::exp(-mean), total = term;
  for (std::uint64_t i = 1; i <= events; ++i) total += term *= mean / static_cast<double>(i);
  return total;
}

Json to_json(const TrialResult& r) {
  return {{"seed", r.seed},
          {"failures", r.failures},
          {"contacts", r.contacts},
          {"contacts_by_hand", r.contacts_by_hand},
          {"promise_violations", r.promise_violations},
          {"firmware_violations", r.firmware_violations},
          {"proposals", r.proposals},
          {"grants", r.grants},
          {"denials", r.denials},
          {"robots", r.robots},
          {"idle", r.idle},
          {"robot_s", r.robot_s},
          {"moved_m", r.moved_m},
          {"calm_moved_m", r.calm_moved_m},
          {"min_clearance_m", r.min_clearance_m},
          {"wall_s", r.wall_s}};
}

}  // namespace

std::string to_line(const TrialResult& result) { return to_json(result).dump(); }

TrialResult result_from(const std::string& line) {
  const Json json = Json::parse(line);
  TrialResult r;
  json.at("seed").get_to(r.seed);
  json.at("failures").get_to(r.failures);
  json.at("contacts").get_to(r.contacts);
  json.at("contacts_by_hand").get_to(r.contacts_by_hand);
  json.at("promise_violations").get_to(r.promise_violations);
  json.at("firmware_violations").get_to(r.firmware_violations);
  json.at("proposals").get_to(r.proposals);
  json.at("grants").get_to(r.grants);
  json.at("denials").get_to(r.denials);
  json.at("robots").get_to(r.robots);
  json.at("idle").get_to(r.idle);
  json.at("robot_s").get_to(r.robot_s);
  json.at("moved_m").get_to(r.moved_m);
  json.at("calm_moved_m").get_to(r.calm_moved_m);
  json.at("min_clearance_m").get_to(r.min_clearance_m);
  json.at("wall_s").get_to(r.wall_s);
  return r;
}

double upper_bound_95(std::uint64_t events, double time) {
  if (time <= 0) return std::numeric_limits<double>::infinity();
  double low = 0, high = 10 + 3 * static_cast<double>(events);
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (poisson(events, middle) > 0.05 ? low : high) = middle;
  }
  return high / time;
}

std::uint64_t SearchSummary::sum(std::uint64_t TrialResult::*count) const {
  std::uint64_t total = 0;
  for (const auto& [seed, result] : results_) total += result.*count;
  return total;
}

std::uint64_t SearchSummary::failed() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(results_, [](const auto& entry) { return !entry.second.failures.empty(); }));
}

double SearchSummary::robot_hours() const {
  double total_s = 0;
  for (const auto& [seed, result] : results_) total_s += result.robot_s;
  return total_s / 3600;
}

template <typename Value>
std::string SearchSummary::extremes(Value value, bool are_largest) const {
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

std::string SearchSummary::text() const {
  double moved_m = 0, wall_s = 0;
  for (const auto& [seed, result] : results_) {
    moved_m += result.moved_m;
    wall_s += result.wall_s;
  }
  const double hours = robot_hours();
  std::string text = fmt::format(
      "{} seeds, {} failed; {:.2f} robot-hours, {:.1f} km driven; {} contacts, {} violations of ledger and "
      "promise, {} "
      "of firmware rules\n",
      seeds(), failed(), hours, moved_m / 1000, contacts(), sum(&TrialResult::promise_violations),
      sum(&TrialResult::firmware_violations));
  if (const auto by_hand = sum(&TrialResult::contacts_by_hand); by_hand > 0) {
    text += fmt::format(
        "{} more contacts where robots were pushed, slipped or started again, which is beyond the bounds\n",
        by_hand);
  }
  text += fmt::format(
      "so with 95 % confidence there are at most {:.3g} contacts per robot-hour under these faults\n",
      upper_bound_95(contacts(), hours));
  text += fmt::format("{} proposals, {:.2f} % denied; {:.0f} robot-seconds per second and core\n",
                      sum(&TrialResult::proposals),
                      100 * share(sum(&TrialResult::denials), sum(&TrialResult::proposals)),
                      wall_s > 0 ? hours * 3600 / wall_s : 0);
  text +=
      "least driven, in metres per robot and minute: " +
      extremes([](const TrialResult& r) { return r.robot_s > 0 ? 60 * r.moved_m / r.robot_s : 0; }, false) +
      "\n";
  text += "most denied, as a share: " +
          extremes([](const TrialResult& r) { return share(r.denials, r.proposals); }, true) + "\n";
  text += "most robots that stood still at the end, as a share: " +
          extremes([](const TrialResult& r) { return r.robots > 0 ? double(r.idle) / r.robots : 0; }, true) +
          "\n";
  text += "least clearance, in metres: " +
          extremes([](const TrialResult& r) { return r.min_clearance_m; }, false) + "\n";
  return text;
}

std::string SearchSummary::json() const {
  Json json;
  json["commit"] = kCommit;
  json["seeds"] = seeds();
  json["failed"] = failed();
  json["robot_hours"] = robot_hours();
  json["contacts"] = contacts();
  json["promise_violations"] = sum(&TrialResult::promise_violations);
  json["firmware_violations"] = sum(&TrialResult::firmware_violations);
  json["contacts_per_robot_hour_95"] = upper_bound_95(contacts(), robot_hours());
  json["trials"] = Json::array();
  for (const auto& [seed, result] : results_) json["trials"].push_back(to_json(result));
  return json.dump(1) + "\n";
}

}  // namespace sidestep
