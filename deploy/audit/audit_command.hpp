// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep audit`. Parsing it sets `action`, which returns the exit code of the audit's verdict and
/// may throw std::runtime_error.
void add_audit_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
