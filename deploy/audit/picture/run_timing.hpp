// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "deploy/audit/metrics/floor_trace.hpp"

namespace sidestep {

/// How the picture of a run plays: from its begin to its end, then it pauses and begins again.
struct RunTiming {
  static constexpr double kPause_s = 1.5;
  double begin_s = 0, end_s = 0;  ///< times of the run
  double speed = 1;               ///< multiple of real time: long runs play faster

  bool plays() const { return end_s > begin_s; }
  /// Duration of one round in the viewer's seconds.
  double round_s() const { return (end_s - begin_s) / speed + kPause_s; }
  /// A time of the run as a share of a round.
  double share(double at_s) const;
};

[[nodiscard]] RunTiming timing_of(const FloorTrace& trace);

/// Where a robot was, between two points of its path by even motion. The path must not be empty.
[[nodiscard]] Vec2 position_at(const std::vector<FloorTrace::Point>& path, double at_s);

/// A place at a time of the run.
struct TimedPlace {
  double at_s;
  Vec2 px;
};

/// The attributes values, keyTimes, dur and repeatCount of an SVG animation with these values at these times,
/// which must ascend; the last value lasts until the end of the round.
[[nodiscard]] std::string animation_attributes(const RunTiming& timing, const std::vector<double>& at_s,
                                               const std::vector<std::string>& values);

/// The animation of a group's translation along places.
[[nodiscard]] std::string svg_motion(const RunTiming& timing, const std::vector<TimedPlace>& places);

}  // namespace sidestep
