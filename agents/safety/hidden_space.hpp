// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "agents/perception/frontier.hpp"
#include "common/motion/trajectory.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The floor that a robot's laser did not see. Only its border is known; see Visibility. People may have come
/// from this border at up to their maximum speed since the time of the scan.
struct HiddenSpace {
  std::span<const Frontier> frontiers{};    ///< places where people may step out
  std::span<const Frontier> closed_gaps{};  ///< gaps too narrow for people, who may protrude through them
  Time observed_at{};
  double speed_mps = 0;          ///< upper bound of people's speed
  double heading_error_rad = 0;  ///< bound of the error of the scan's heading
  double creep_mps = 0;          ///< a slower robot counts as being at rest
  Vec2 observed_from_m{0, 0};

  [[nodiscard]] bool is_nothing() const { return frontiers.empty() && closed_gaps.empty(); }
  /// A lower bound of the distance between a point and any person who was hidden, at a time after the
  /// observation. Negative: the point may be covered.
  [[nodiscard]] double distance_m(const Vec2& p, Time t) const;
};

/// Whether the robot is at rest before a person who was hidden could reach it (passive safety), or creeps to
/// a place where no person can be nearer than at its present place. Without this exception, a robot next to a
/// place where a person may step out could not leave. Until the trajectory ends, the disc of radius
/// `min_separation_m`, the robot's radius plus the margin, around its centre stays clear of all positions
/// that a person may have reached from a frontier. Precondition: the trajectory begins in the region that was
/// seen. Conservative: never falsely true; false negatives only within a millimetre.
///
/// A distance decreases at most at the sum of both speeds. So a distance that is large enough now stays large
/// enough for a known time, and the check advances by that time (conservative advancement). A trajectory that
/// never comes near a frontier does not cross one.
[[nodiscard]] bool is_passively_safe_from_hidden(const Trajectory& trajectory, const HiddenSpace& hidden,
                                                 double min_separation_m);

}  // namespace sidestep
