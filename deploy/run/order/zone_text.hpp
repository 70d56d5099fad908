// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/protocol/order.hpp"

namespace sidestep {

/// Parses a zone with these corners, each given as "X,Y" in metres. Throws UsageError if there are too many
/// corners, or if the zone covers no area.
[[nodiscard]] Zone parse_zone(const std::vector<std::string>& corners, double radius_m,
                              std::optional<double> speed_limit_mps);

}  // namespace sidestep
