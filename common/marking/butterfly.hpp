// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/marking/layout.hpp"

namespace sidestep {

/// The standard pattern of the Small Size League: four dots, pink or green, for 16 ids.
const MarkerLayout& butterfly();

}  // namespace sidestep
