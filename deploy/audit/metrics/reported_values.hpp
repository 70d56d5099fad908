// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "deploy/audit/metrics/arrivals.hpp"

namespace sidestep {

// Values of a report that was read from a file. They throw std::invalid_argument or nlohmann::json::exception
// if the report is damaged.

[[nodiscard]] Arrivals reported_arrivals(const nlohmann::ordered_json& report);

}  // namespace sidestep
