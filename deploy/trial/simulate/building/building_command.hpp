// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep building`. Parsing it sets `action`, which returns 0 and throws what write_building()
/// throws.
void add_building_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
