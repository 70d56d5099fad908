// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/perception/laser_beams.hpp"
#include "agents/perception/sight_border.hpp"

namespace sidestep {

struct VisibilitySettings {
  double person_radius_m = 0.15;  ///< of the smallest person, at the height of the laser
  double range_error_m = 0.03;    ///< bound of the error of ranges
};

/// What Visibility::max_speed_mps has to know about the robot and about people.
struct BrakingQuery {
  Vec2 at_m{0, 0};        ///< the robot, at `now`
  Vec2 direction{1, 0};   ///< of motion, of length 1
  double radius_m = 0.2;  ///< of the robot
  Time now{};
  double reaction_s = 0.1;        ///< the robot keeps its speed for this time ...
  double deceleration_mps2 = 1;   ///< ... and then brakes with this until it is at rest
  double person_speed_mps = 1.5;  ///< upper bound
  double limit_mps = 1;           ///< the answer is at most this
};

/// What a robot did not see in its last scan, and how fast it may drive although a person may step out there.
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
/// **Speed.** A point of a person that touches the robot at time t was outside the region at the time of the
/// scan t0, so it, or the centre before it, has crossed a frontier, and was at least as far from there as the
/// frontier's bulge allows. So no person touches the robot at position x while
///     distance(x, frontier) > radius + bulge + v_p (t - t0)      for all frontiers.
/// A robot that drives at v, reacts for T and brakes with D comes to rest after s(v) = v T + v² / (2 D), at
/// the time g(v) = T + v / D from now. Of all robots that drive at most at v, the one that comes to rest at a
/// position is the last to move there. So all of them are safe if, for all u from 0 to v,
///     distance(x(s(u)), frontier) > radius + bulge + v_p (age + g(u)).
/// The left side falls at most as fast as s grows, which bounds the next u that can violate this from below:
/// the search steps there, and never beyond the answer. Closed gaps limit the speed likewise, without v_p,
/// unless the robot is within their reach already and moves away.
class Visibility {
 public:
  /// Throws std::invalid_argument if a setting is not finite, the radius not positive or the error negative.
  explicit Visibility(const VisibilitySettings& settings = {});

  /// `is_standing(beam)`: whether the hit of this beam is on something that stands and will not move, e.g. a
  /// wall of the map. Does not allocate once warm.
  template <typename IsStanding>
  void update(const LaserBeams& beams, const IsStanding& is_standing) {
    begin(beams);
    double angle_rad = 0;
    for (int beam = 0; beam < beams.count(); angle_rad += beams.gap_rad(beam), ++beam)
      add(beams[beam], angle_rad, beams[beam].end == BeamEnd::kHit && is_standing(beam));
    finish();
  }

  /// Whether no hidden person covered the point at the time of the scan. Never falsely true.
  [[nodiscard]] bool was_seen_free(const Vec2& p) const { return seen_.contains(p); }
  /// Where people may step out, counter-clockwise around the scanner.
  std::span<const Frontier> frontiers() const { return reach_.frontiers(); }
  /// Between hits on things that stand; too narrow for people.
  std::span<const Frontier> closed_gaps() const { return reach_.closed_gaps(); }

  /// The highest speed up to which, at every speed, the robot comes to rest before a person who may have been
  /// hidden at the time of the scan can touch it. A person may walk into a robot at rest; people and things
  /// that the scan shows are considered as far as `is_standing` did not say that they stand. 0 if even a slow
  /// robot can be touched. Never optimistic; too low by at most a millimetre per second, or where the
  /// robot passes a frontier closely. Throws std::invalid_argument for numbers out of range.
  [[nodiscard]] double max_speed_mps(const BrakingQuery& query) const;

 private:
  void begin(const LaserBeams& beams);
  void add(const Beam& beam, double angle_rad, bool is_standing);
  void finish();

  VisibilitySettings settings_;
  Vec2 at_m_{0, 0};
  Time captured_at_{};
  std::vector<SightRay> rays_;
  SightBorder seen_;   // what was seen
  SightBorder reach_;  // what people reach only through its frontiers
};

}  // namespace sidestep
