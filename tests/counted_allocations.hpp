// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace sidestep {

/// How often this program has called operator new so far. Only in programs that list counted_allocations.cpp
/// among their sources, which replaces the operator.
std::size_t allocations();

}  // namespace sidestep
