// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "common/marking/layout.hpp"
#include "common/process/command_line.hpp"

namespace sidestep {

/// Evaluates a layout, as in the comparison of patterns by Bruce (CMU-CS-06-181, appendix A.2.3): the number
/// of patterns that its dots can show with two to six colours and with the colours it uses, the minimum
/// distance of its patterns, and the pose error for a standard deviation of `dot_sd_m` per axis in each dot's
/// position.
[[nodiscard]] std::string describe_layout(const MarkerLayout& layout, double dot_sd_m);

/// Adds `pattern`, which prints the evaluation of a layout. Parsing it sets `action` to the command, which
/// returns the exit code, and may throw ConfigError for the layout's file.
void add_pattern_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
