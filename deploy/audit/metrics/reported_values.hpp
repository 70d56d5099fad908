// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "deploy/audit/metrics/arrivals.hpp"

namespace sidestep {

// Values of a report that was read from a file. They throw std::invalid_argument or nlohmann::json::exception
// if the report is damaged.

/// nullopt: the value is no number. A number that no run can have is damage.
[[nodiscard]] std::optional<double> reported_number(const nlohmann::ordered_json& value);

/// A number that every report has.
[[nodiscard]] double required_number(const nlohmann::ordered_json& report, const char* key);

[[nodiscard]] Arrivals reported_arrivals(const nlohmann::ordered_json& report);

/// Contacts or crashes that the verdict does not count.
struct ExcludedCounts {
  double excused = 0;    ///< by disturbances
  double undecided = 0;  ///< the audit does not know the robots, or whether a disturbance excuses them
};
/// What Report::unexcused_contacts() and Report::unexcused_crashes() exclude.
[[nodiscard]] ExcludedCounts excluded_contacts(const nlohmann::ordered_json& report);
[[nodiscard]] ExcludedCounts excluded_crashes(const nlohmann::ordered_json& report);

}  // namespace sidestep
