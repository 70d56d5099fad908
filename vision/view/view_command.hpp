// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep-vision view`, which receives images from a running system, runs detection on them, and
/// writes annotated pictures.
void add_view_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
