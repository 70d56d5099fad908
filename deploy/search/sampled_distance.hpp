// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/trajectory.hpp"

namespace sidestep {

/// Whether two motions come nearer than `keep_m` (between centres) from a time on, found by stepping along
/// both: shares nothing with the clearance that the search and the ledger use.
bool come_nearer(const Trajectory& a, const Trajectory& b, double keep_m, Time from);

}  // namespace sidestep
