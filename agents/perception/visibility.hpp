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
  double min_contact_m = 0;  ///< no contact with a person is nearer than this to known stationary objects
};

/// A lower bound of the distance between known stationary objects and the place where a robot can touch a
/// person. The robot has the radius `robot_radius_m` and stays `clear_m` away from stationary objects; people
/// have at least the radius `person_radius_m`.
///
/// Derivation, with ρ = robot_radius_m, c = clear_m and r = person_radius_m: let P be the place of contact, Q
/// the nearest point of a stationary object, and a the component of PQ towards the person's centre. The
/// person does not overlap Q, so PQ² >= 2 a r. The robot stays clear of Q, so PQ² >= c (2 ρ + c) - 2 a ρ. The
/// larger of these two bounds is smallest where they are equal.
[[nodiscard]] double min_contact_distance_m(double robot_radius_m, double clear_m, double person_radius_m);

/// The floor that a robot did not see in its last scan, and the places where a person may step out.
///
/// **Seen free.** A person is a disc of at least the smallest radius r. Whether seen or hidden, no beam
/// crosses this disc before the beam's end. Take two neighbouring known beams at an angle a, and the line
/// that crosses both at a distance p from the scanner. The disc covers only a part of the line between the
/// beams: a chord of at most c = 2 p sin(a / 2). If c < 2 r, the centre cannot be on the scanner's side of
/// the line, and the disc protrudes across the line by at most the sagitta r - sqrt(r² - c² / 4). A larger
/// disc protrudes less. For a wide angle, the nearest point that a disc can reach between the beams is at r /
/// sin(a / 2) - r. The region before these lines was seen free. Beams without information are left out, which
/// widens the angle between the others. Beams that end at a narrow object are also left out if no person fits
/// into its shadow.
///
/// **Closed and open.** The end of a beam does not show what it has hit: the side of a person who stands in a
/// doorway or leans against a wall is as near to the wall as the measured wall itself. But no person's centre
/// is nearer than r to a known stationary object, whatever the beam has hit. So the line between the ends of
/// two neighbouring beams is closed if every point of it is nearer than r to one of two posts: the known
/// stationary points nearest to each end. No person's centre is ever on a closed line. The posts are known in
/// the world's frame, and the line is in the scan's, so r is reduced by the errors of the scan's pose. Beams
/// between two others that form a closed gap are left out of the border, so what they saw behind the gap does
/// not matter. Every other part of the border is open: jumps in range, the maximum range, unseen sectors, and
/// the surfaces of everything that is not within r of known objects, e.g. robots, people and new furniture.
/// The open parts are the frontiers.
///
/// **Consequences.** Let a person touch the robot at y at time t, and let the person's centre have moved from
/// z0 at the time t0 of the scan to z. The curve from z0 along the centre's path to z, and straight on to y,
/// is at most v_p (t - t0) + R long, where R is the person's radius. At t0 the person's disc was outside the
/// region, so the curve crosses the border.
/// - If it crosses an open part at f: the disc did not contain f, so at least R of the curve is before f, up
/// to the bulge, and at most v_p (t - t0) is after it. So no person touches a robot at position x while
/// distance(x, frontier) > radius + bulge + v_p (t - t0)      for all frontiers.
/// - If it crosses a closed line at b, at w from its post Q: b is not on the centre's path, so it is on the
/// radius that ends at y. The disc does not overlap Q, so y is at most sqrt(2 r (r - sqrt(r² - w²))) from Q,
/// which is little more than w. It also protrudes through a gap between two posts by no more than the
/// sagitta. So a closed gap is a frontier that does not grow, unless y is so near to Q that no robot touches
/// a person there: see min_contact_distance_m(). agents/safety/hidden_space.hpp uses this to check
/// trajectories.
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
  [[nodiscard]] bool is_enclosed_by_frontiers(const Vec2& p) const { return reach_.contains(p); }
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
