// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/process/command_line.hpp"

namespace sidestep {

/// Adds `sidestep keys`. Parsing it sets `action`, which returns the exit code and throws what KeyStore
/// throws.
void add_keys_command(const CliCommand& root, std::function<int()>& action);

}  // namespace sidestep
