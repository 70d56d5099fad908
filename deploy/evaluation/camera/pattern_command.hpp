// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "common/marking/layout.hpp"

namespace CLI {
class App;
}

namespace sidestep {

/// What a layout can tell: how many patterns its dots could show with two to six colours and with those it
/// uses, how alike its patterns are, and the error of a pose when each dot's position has an error of this
/// standard deviation per axis.
std::string describe_layout(const MarkingLayout& layout, double dot_sd_m);

/// Adds `pattern`, which prints that. When it is parsed, `action` becomes what is to be run; it returns the
/// exit code, and may throw ScenarioError for a layout's file.
void add_pattern_command(CLI::App& root, std::function<int()>& action);

}  // namespace sidestep
