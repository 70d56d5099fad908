// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep robot absent`: the operator attests that a robot that has not registered is not on the
/// floor.
void add_attest_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
