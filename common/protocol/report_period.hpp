// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

/// A robot repeats its report once a control cycle has passed since the last one, in the next period of its
/// control loop. This is the longest such period.
inline constexpr Duration kMaxReportDelay{10'000'000};

/// The longest time between two reports of a robot on the floor that knows its pose.
constexpr Duration max_report_gap(Duration cycle) { return cycle + kMaxReportDelay; }

}  // namespace sidestep
