// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/marking/butterfly.hpp"
#include "common/random/rng.hpp"
#include "vision/patterns/identifier.hpp"

namespace sidestep::test {

/// A robot on the floor, and what it wears.
struct Marked {
  RosterEntry entry;
  Pose pose;
};

struct Noise {
  double sd_m = 0;     ///< of each dot's position, per axis
  double area_sd = 0;  ///< relative
  int hidden = 0;      ///< dots of each robot that are not seen, the centre among them, drawn
};

inline double disc_m2(double radius_m) { return 3.14159265358979 * radius_m * radius_m; }

/// The patches of robots, in random order.
inline std::vector<Patch> patches_of(const MarkingLayout& layout, const std::vector<Marked>& robots,
                                     const Noise& noise, Rng& rng) {
  std::vector<Patch> patches;
  const auto see = [&](Colour colour, const Vec2& at_m, double radius_m) {
    const Vec2 error = noise.sd_m * Vec2(rng.normal(), rng.normal());
    patches.push_back({colour, at_m + error, disc_m2(radius_m) * (1 + noise.area_sd * rng.normal())});
  };
  for (const Marked& robot : robots) {
    std::vector<bool> is_hidden(layout.dots.size() + 1);
    for (int i = 0; i < noise.hidden;) {
      const std::size_t k = rng.below(is_hidden.size());
      i += is_hidden[k] ? 0 : 1;
      is_hidden[k] = true;
    }
    if (!is_hidden.back())
      see(layout.team_colour(robot.entry.team), robot.pose.to_world(layout.centre.position_m),
          layout.centre.radius_m);
    for (std::size_t k = 0; k < layout.dots.size(); ++k) {
      if (!is_hidden[k])
        see(robot.entry.pattern.colours[k], robot.pose.to_world(layout.dots[k].position_m),
            layout.dots[k].radius_m);
    }
  }
  rng.shuffle(patches);
  return patches;
}

/// Robots of both teams with the layout's first patterns, which do not overlap.
inline std::vector<Marked> scattered(const MarkingLayout& layout, std::size_t each, double apart_m,
                                     Rng& rng) {
  std::vector<Marked> robots;
  while (robots.size() < 2 * each) {
    const std::size_t i = robots.size() % each;
    const bool is_blue = robots.size() < each;
    const Pose pose{{rng.uniform(-3, 3), rng.uniform(-2, 2)}, rng.uniform(-3.14159, 3.14159)};
    bool is_free = true;
    for (const Marked& other : robots) is_free &= (other.pose.position_m - pose.position_m).norm() > apart_m;
    if (!is_free) continue;
    const auto id = static_cast<RobotId>(is_blue ? i : 16 + i);
    robots.push_back({{id, is_blue ? Team::kBlue : Team::kYellow, layout.patterns[i]}, pose});
  }
  return robots;
}

inline std::vector<RosterEntry> roster_of(const std::vector<Marked>& robots) {
  std::vector<RosterEntry> roster;
  for (const Marked& robot : robots) roster.push_back(robot.entry);
  return roster;
}

inline std::vector<ExpectedRobot> expected_of(const std::vector<Marked>& robots) {
  std::vector<ExpectedRobot> expected;
  for (const Marked& robot : robots) expected.push_back({robot.entry.robot, robot.pose});
  return expected;
}

}  // namespace sidestep::test
