// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

/// The local time at which a frame was captured, and the maximum error of this time.
struct DatedCapture {
  Time captured_at{};
  Duration uncertainty{0};
};

}  // namespace sidestep
