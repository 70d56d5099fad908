// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `study ...` to a program. When one of its commands is parsed, `action` becomes what to run; that
/// returns the exit code, and may throw std::runtime_error that says what failed.
void add_study_command(const Command& root, std::function<int()>& action);

}  // namespace sidestep
