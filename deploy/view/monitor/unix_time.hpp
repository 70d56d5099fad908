// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

/// Seconds since 1970 as used in JSON, accurate to a microsecond.
inline double unix_seconds(Time time) { return static_cast<double>(to_ns(time)) * 1e-9; }

}  // namespace sidestep
