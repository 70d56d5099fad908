// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/perception/laser_beams.hpp"
#include "agents/perception/sight_border.hpp"

namespace sidestep {

struct VisibilitySettings {
  double person_radius_m = 0.15;  ///< radius of the smallest person at laser height
  double range_error_m = 0.03;    ///< bound of the error of ranges
  // Bounds of the errors of a scan's pose. They also bound the errors of known stationary points in the
  // scan's frame.
  double position_error_m = 0;
  double heading_error_rad = 0;
  double untouched_m = 0;  ///< a robot touches nobody nearer than this to something known to be stationary
};

/// A lower bound of the distance between known stationary objects and the place where a robot can touch a
/// person. The robot has the radius `robot_radius_m` and stays `clear_m` away from stationary objects; people
/// have at least the radius `person_radius_m`.
///
/// Let P be the place of contact, between the centres, at a from a post Q along the line from P to the
/// person's centre. As the person does not overlap Q, PQ² >= 2 a r; as the robot stays clear of it, PQ² >= c
/// (2 ρ + c) - 2 a ρ. The larger of both is least where they are equal.
[[nodiscard]] double untouched_distance_m(double robot_radius_m, double clear_m, double person_radius_m);

/// The floor that a robot did not see in its last scan, and from where a person may step out.
///
/// **Seen free.** A person is a disc of at least the smallest radius r. Whether seen or hidden, no beam
/// crosses this disc before the beam's end. Take two neighbouring known beams at an angle a, and a line
/// across both at the distances p along each. What the disc covers of the line lies between the beams, so it
/// is a chord of at most c = 2 p sin(a / 2). If c < 2 r, the centre cannot be on the near side, and the disc
/// protrudes across the line by at most the sagitta r - sqrt(r² - c² / 4). A larger disc protrudes less. For
/// a wide angle the nearest point that a disc can reach between the beams is at r / sin(a / 2) - r. The
/// region before these lines was seen free. Beams without information are left out, which widens the angle
/// between the others. Beams that end at something narrow are left out too, if nobody fits into its shadow.
///
/// **Closed and open.** The end of a beam does not show what it has hit: the side of a person who stands in a
/// doorway or leans against a wall is as near to the wall as the measured wall itself. But nobody's centre is
/// nearer than r to what is known to be stationary, whatever was seen there. So the line between the ends of
/// two neighbouring beams is closed if every point of it is nearer than r to one of two known posts: the
/// nearest one to each end. No centre is ever on it. The posts are known in the world's frame, and the line
/// is in the scan's, so r is reduced by the errors of the scan's pose. Beams between two others that form a
/// closed gap are left out of the border, so what is behind it does not count. Every other border is open:
/// jumps in range, the maximum range, unseen sectors, and the surfaces of everything that is not within r of
/// known things, e.g. robots, people and new furniture. These are the frontiers.
///
/// **What follows.** Let a person touch the robot at y at time t, and let his centre have moved from z0 at
/// the time t0 of the scan to z. The curve from z0 along the centre's path to z, and straight on to y, has
/// the length v_p (t - t0) + R with his radius R. At t0 his disc was outside the region, so the curve crosses
/// the border.
/// - At an open place f: the disc did not contain f, so f is at least R along the curve, up to the bulge, and
/// at most v_p (t - t0) of it remain. So no person touches a robot at position x while distance(x, frontier)
/// > radius + bulge + v_p (t - t0)      for all frontiers.
/// - At a closed place b, at w from its post Q: not on the centre's path, so b is on the radius that ends at
/// y. The disc does not overlap Q, which is possible only if y is at most sqrt(2 r (r - sqrt(r² - w²))) from
/// Q: little more than w. It also protrudes through a gap between two posts by no more than the sagitta. So a
/// closed gap is a frontier that does not grow, unless y is so near to Q that no robot touches anybody there:
/// see untouched_distance_m(). agents/safety/hidden_space.hpp uses this to check trajectories.
class Visibility {
 public:
  /// Throws std::invalid_argument if a setting is not finite, the radius is not positive, or another setting
  /// is negative.
  explicit Visibility(const VisibilitySettings& settings = {});

  /// `nearest_known(p, within_m)` returns the known stationary point nearest to p, or nullopt if there is
  /// none within that distance. Does not allocate once warm.
  template <typename NearestKnown>
  void update(const LaserBeams& beams, const NearestKnown& nearest_known) {
    begin(beams);
    for (SightRay& ray : rays_)
      if (const std::optional<Vec2> post = nearest_known(end_m(ray), settings_.person_radius_m))
        set_post(ray, *post);
    finish();
  }

  /// Whether no hidden person covered the point at the time of the scan. Never falsely true.
  [[nodiscard]] bool was_seen_free(const Vec2& p) const { return seen_.contains(p); }
  /// Whether people can reach the point only through frontiers or closed gaps. Never falsely true.
  [[nodiscard]] bool is_before_frontiers(const Vec2& p) const { return reach_.contains(p); }
  /// Places where people may step out, sorted counter-clockwise around the scanner.
  std::span<const Frontier> frontiers() const { return reach_.frontiers(); }
  /// Gaps between known stationary objects that are too narrow for people.
  std::span<const Frontier> closed_gaps() const { return reach_.closed_gaps(); }

 private:
  void begin(const LaserBeams& beams);
  Vec2 end_m(const SightRay& ray) const { return at_m_ + ray.free_m * ray.direction; }
  void set_post(SightRay& ray, const Vec2& post_m) const;
  void finish();

  VisibilitySettings settings_;
  Vec2 at_m_{0, 0};
  std::vector<SightRay> rays_;
  SightBorder seen_;   // border of the seen region
  SightBorder reach_;  // border of the region that people can reach only through its frontiers
};

}  // namespace sidestep
