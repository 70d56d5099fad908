// SPDX-License-Identifier: Apache-2.0
#include "simulator/league/packet_times.hpp"

#include <algorithm>

namespace sidestep {

FrameStamps packet_times(const PacketTimeSettings& settings, const FrameStamps& real,
                         const FrameStamps& simulated) {
  FrameStamps times = real;
  if (settings.start) times = {*settings.start + simulated.captured, *settings.start + simulated.sent};
  if (settings.capture_error > Duration::zero())
    times.captured = std::min(times.captured + settings.capture_error, times.sent);
  return times;
}

}  // namespace sidestep
