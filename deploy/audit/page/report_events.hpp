// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace sidestep {

/// Something that happened in a run, according to its report.
struct ReportEvent {
  std::optional<double> at_s;  ///< nullopt: not known
  bool is_bad = false;         ///< it fails the run, or may have
  std::string text;
};

/// The events of a report in the order of their times; those without a time come last.
[[nodiscard]] std::vector<ReportEvent> events_of(const nlohmann::ordered_json& report);

}  // namespace sidestep
