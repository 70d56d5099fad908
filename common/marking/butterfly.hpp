// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/marking/layout.hpp"

namespace sidestep {

/// The Small Size League's standard pattern: four dots that are pink or green, 16 ids.
const MarkingLayout& butterfly();

}  // namespace sidestep
