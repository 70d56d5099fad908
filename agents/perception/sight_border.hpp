// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "agents/perception/frontier.hpp"
#include "agents/perception/sight_rays.hpp"

namespace sidestep {

/// The border of the region that rays prove free of hidden people; see Visibility for the derivation.
class SightBorder {
 public:
  /// `radius_m` is the radius of the smallest person. No robot can touch a person at a place nearer than
  /// `min_contact_m` to a stationary object. Does not allocate once warm.
  void build(std::span<const SightRay> rays, const Vec2& at_m, double radius_m, double min_contact_m);

  /// Whether a point is in the region. False within a nanometre of the border.
  [[nodiscard]] bool contains(const Vec2& p) const;
  /// Places where people may step out, sorted counter-clockwise around the scanner.
  std::span<const Frontier> frontiers() const { return frontiers_; }
  /// Gaps between stationary objects that are too narrow for people. The bulge is 0 if a person who protrudes
  /// through the gap cannot touch a robot.
  std::span<const Frontier> closed_gaps() const { return closed_; }

 private:
  /// The region seen between a ray and the next ray: the offset along `normal` is at most `height_m`.
  struct Wedge {
    double angle_rad;  // angle of the ray
    Vec2 normal;
    double height_m;
  };

  Wedge closed_wedge(const SightRay& ray, const SightRay& next, const ClosedGap& gap, double min_contact_m);
  Wedge open_wedge(const SightRay& ray, const SightRay& next, double radius_m);
  void add_frontier(const Vec2& from_m, const Vec2& to_m, double bulge_m);

  Vec2 at_m_{0, 0}, first_direction_{1, 0};
  std::vector<Wedge> wedges_;
  std::vector<Frontier> frontiers_, closed_;
};

}  // namespace sidestep
