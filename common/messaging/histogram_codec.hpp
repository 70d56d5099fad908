// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/histogram.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Encodes a histogram. Counts beyond 32 bits saturate at the message's maximum.
msg::DurationCounts encode(const DurationHistogram& histogram);

/// Any message gives a valid histogram; a hostile one gives wrong figures.
[[nodiscard]] DurationHistogram decode(const msg::DurationCounts& message);

}  // namespace sidestep
