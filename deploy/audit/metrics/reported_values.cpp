// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/reported_values.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/motion/version.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMaxNumber = 1e15;

int number_of_robots(const Json& json) {
  const double number = json.get<double>();
  if (!(number >= 0 && number <= kMaxRobots))
    throw std::invalid_argument(fmt::format("is a damaged report: {:g} is not a number of robots", number));
  return static_cast<int>(number);
}

/// A count of the audit; 0 if the run was not audited, or by a version that did not count this.
double audit_count(const Json& report, const char* key) {
  const Json& audit = report.at("audit");
  const auto found = audit.find(key);
  return found == audit.end() ? 0 : reported_number(*found).value_or(0);
}

}  // namespace

std::optional<double> reported_number(const Json& value) {
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  if (!(std::abs(number) <= kMaxNumber))
    throw std::invalid_argument(fmt::format("is a damaged report: {:g} is not between -{:g} and {:g}", number,
                                            kMaxNumber, kMaxNumber));
  return number;
}

double required_number(const Json& report, const char* key) {
  const auto number = reported_number(report.at(key));
  if (!number) throw std::invalid_argument(fmt::format("is a damaged report: {} is not a number", key));
  return *number;
}

Arrivals reported_arrivals(const Json& report) {
  const auto without_goal = report.find("without_goal");
  const Arrivals arrivals{number_of_robots(report.at("robots")), number_of_robots(report.at("arrived")),
                          without_goal == report.end() ? 0 : number_of_robots(*without_goal)};
  if (arrivals.with_goal() < 0)
    throw std::invalid_argument("is a damaged report: more robots lack a goal than there are");
  return arrivals;
}

ExcludedCounts excluded_contacts(const Json& report) {
  return {audit_count(report, "excused_contacts"),
          audit_count(report, "unidentified_contacts") + audit_count(report, "undecided_contacts")};
}

ExcludedCounts excluded_crashes(const Json& report) {
  return {audit_count(report, "excused_crashes"), audit_count(report, "undecided_crashes")};
}

}  // namespace sidestep
