// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deploy/run/clock/clock_survey.hpp"

namespace sidestep {

/// A table of clocks, one line per process. `reference` names the clock to which offsets are relative.
[[nodiscard]] std::string to_table(const std::vector<ClockRow>& rows, const std::string& reference);

}  // namespace sidestep
