// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace sidestep {

/// Runs the work in a process of its own and returns its exit code. For work that starts threads, in a
/// process that must not start any yet. Throws std::runtime_error if no process can be created, or if it
/// dies.
[[nodiscard]] int run_separately(const std::function<int()>& work);

}  // namespace sidestep
