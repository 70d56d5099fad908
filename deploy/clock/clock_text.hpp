// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deploy/clock/clock_survey.hpp"

namespace sidestep {

/// A table of clocks, one line for each process. `reference` names the clock from which offsets are.
[[nodiscard]] std::string to_table(const std::vector<ClockRow>& rows, const std::string& reference);

}  // namespace sidestep
