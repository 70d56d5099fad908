// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/motion/limits.hpp"
#include "common/protocol/order.hpp"

namespace sidestep {

/// The outline of a zone. A zone with a radius and more than one corner is larger by up to a hundredth of its
/// radius.
[[nodiscard]] Shape outline_of(const Zone& zone);

/// The zones that clients have drawn.
class ZoneMap {
 public:
  ZoneMap() = default;
  /// `orders`: of kind ORDER_ZONE.
  explicit ZoneMap(std::span<const Order> orders);

  /// What to keep out of.
  std::span<const Shape> keep_outs() const { return keep_outs_; }
  /// The clients' numbers of the zones to keep out of, in the order of keep_outs().
  std::span<const std::uint32_t> keep_out_numbers() const { return keep_out_numbers_; }
  /// Circles that stand for the zones to keep out of as seen from a position: those that are circles, and of
  /// others the nearest point of the edge.
  std::vector<Circle> seen_from(const Vec2& position_m) const;
  /// Whether a disc there overlaps a zone to keep out of.
  bool is_kept_out(const Vec2& position_m, double radius_m) const;
  /// The speed that a disc may have there, so that it enters no zone faster than that zone allows.
  /// `reaction`: time until it can begin to brake. Infinite if there is no zone with a speed limit.
  double max_speed_mps(const Vec2& position_m, double speed_mps, double radius_m, Duration reaction,
                       const MotionLimits& limits) const;

 private:
  struct SpeedZone {
    Shape outline;
    double limit_mps;
  };
  std::vector<Shape> keep_outs_;
  std::vector<std::uint32_t> keep_out_numbers_;
  std::vector<SpeedZone> speed_zones_;
};

}  // namespace sidestep
