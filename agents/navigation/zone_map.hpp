// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/motion/limits.hpp"
#include "common/protocol/order.hpp"

namespace sidestep {

/// The outline of a zone. For a zone with a radius and more than one corner, it exceeds the zone by up to a
/// hundredth of the radius.
[[nodiscard]] Shape outline_of(const Zone& zone);

/// The zones that clients have drawn.
class ZoneMap {
 public:
  ZoneMap() = default;
  /// `orders` must be of the kind ORDER_ZONE.
  explicit ZoneMap(std::span<const Order> orders);

  /// Outlines of the keep-out zones.
  std::span<const Shape> keep_outs() const { return keep_outs_; }
  /// The numbers that clients gave to the keep-out zones, in the same order.
  std::span<const std::uint32_t> keep_out_numbers() const { return keep_out_numbers_; }
  /// Circles that represent the keep-out zones, as seen from a position: zones that are circles, and the
  /// nearest edge point of every other zone.
  std::vector<Circle> seen_from(const Vec2& position_m) const;
  /// Whether a disc at this position overlaps a keep-out zone.
  bool is_kept_out(const Vec2& position_m, double radius_m) const;
  /// The maximum speed of a disc at this position such that it enters no zone faster than the zone allows.
  /// `reaction` is the time until it can start to brake. Infinite if no zone has a speed limit.
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
