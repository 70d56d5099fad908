// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace sidestep {

/// The number of calls of operator new in this program so far. Requires counted_allocations.cpp, which
/// replaces the operator, among the program's sources.
std::size_t allocation_count();

}  // namespace sidestep
