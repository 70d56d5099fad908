// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/perception/laser_beams.hpp"
#include "agents/perception/sight_border.hpp"

namespace sidestep {

struct VisibilitySettings {
  double person_radius_m = 0.15;  ///< of the smallest person, at the height of the laser
  double range_error_m = 0.03;    ///< bound of the error of ranges
};

/// What a robot did not see in its last scan: where a person may step out.
///
/// **Seen free.** A hidden person, a disc of the smallest radius r or a larger one, was crossed by no beam at
/// the time of the scan. Take two neighbouring known beams at an angle a, and a line across both at the
/// distances p along each. What the disc covers of the line lies between the beams, so it is a chord of at
/// most c = 2 p sin(a / 2). If c < 2 r, the centre cannot be on the near side, and the disc projects over the
/// line by at most the sagitta r - sqrt(r² - c² / 4). A larger disc projects less. For a wide angle the
/// nearest point that a disc can reach between the beams is at r / sin(a / 2) - r. The region before these
/// lines was seen free. Beams that know nothing are left out, which widens the angle between the others. So
/// are those that end at something narrow, if nobody fits into its shadow.
///
/// **Closed and open.** If the ends of two neighbouring beams are hits on things that stand, closer together
/// than 2 r, no centre passes between them, ever, but the disc can project by the sagitta. Beams within
/// such a gap between two posts are left out of the border, so what is behind it does not count.
/// Every other border is open: jumps in range, the maximum range, unseen sectors, and hits on anything that
/// may move, e.g. robots and people. These are the frontiers.
///
/// **What follows.** A point of a person that touches the robot at time t was outside the region at the time
/// of the scan t0, so it, or the centre before it, has crossed a frontier, and was at least as far from there
/// as the frontier's bulge allows. So no person touches a robot at position x while
///     distance(x, frontier) > radius + bulge + v_p (t - t0)      for all frontiers.
/// agents/safety/hidden_space.hpp checks trajectories by this.
class Visibility {
 public:
  /// Throws std::invalid_argument if a setting is not finite, the radius not positive or the error negative.
  explicit Visibility(const VisibilitySettings& settings = {});

  /// `is_standing(beam)`: whether the beam ends at something that stands and will not move, e.g. a wall of
  /// the map. Does not allocate once warm.
  template <typename IsStanding>
  void update(const LaserBeams& beams, const IsStanding& is_standing) {
    begin(beams);
    double angle_rad = 0;
    for (int beam = 0; beam < beams.count(); angle_rad += beams.gap_rad(beam), ++beam)
      add(beams[beam], angle_rad, is_hit(beams[beam]) && is_standing(beam));
    finish();
  }

  /// Whether no hidden person covered the point at the time of the scan. Never falsely true.
  [[nodiscard]] bool was_seen_free(const Vec2& p) const { return seen_.contains(p); }
  /// Whether people reach the point only through frontiers or closed gaps. Never falsely true.
  [[nodiscard]] bool is_before_frontiers(const Vec2& p) const { return reach_.contains(p); }
  /// Where people may step out, counter-clockwise around the scanner.
  std::span<const Frontier> frontiers() const { return reach_.frontiers(); }
  /// Between hits on things that stand; too narrow for people.
  std::span<const Frontier> closed_gaps() const { return reach_.closed_gaps(); }

 private:
  static bool is_hit(const Beam& beam) { return beam.end == BeamEnd::kHit || beam.end == BeamEnd::kRobot; }
  void begin(const LaserBeams& beams);
  void add(const Beam& beam, double angle_rad, bool is_standing);
  void finish();

  VisibilitySettings settings_;
  Vec2 at_m_{0, 0};
  std::vector<SightRay> rays_;
  SightBorder seen_;   // what was seen
  SightBorder reach_;  // what people reach only through its frontiers
};

}  // namespace sidestep
