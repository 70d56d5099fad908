// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/histogram.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Encodes a histogram. Counts beyond 32 bits saturate at the message's maximum.
msg::DurationCounts encode(const DurationHistogram& histogram);

/// Decodes an untrusted histogram. The result is always valid, but its counts may be wrong.
[[nodiscard]] DurationHistogram decode(const msg::DurationCounts& message);

}  // namespace sidestep
