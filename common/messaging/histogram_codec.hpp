// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/histogram.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Counts beyond 32 bits saturate at the maximum of the message.
msg::DurationCounts encode(const DurationHistogram& histogram);

/// Any message gives a valid histogram; a hostile one gives wrong figures.
[[nodiscard]] DurationHistogram decode(const msg::DurationCounts& message);

}  // namespace sidestep
