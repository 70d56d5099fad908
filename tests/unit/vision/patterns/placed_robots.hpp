// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <vector>

#include "common/marking/butterfly.hpp"
#include "common/random/rng.hpp"
#include "tests/unit/common/random/normal_vector.hpp"
#include "vision/patterns/identifier.hpp"

namespace sidestep::test {

/// A robot's roster entry and pose.
struct PlacedRobot {
  RosterEntry entry;
  Pose pose;
};

struct Noise {
  double sd_m = 0;     ///< standard deviation of each dot's position, per axis
  double area_sd = 0;  ///< relative standard deviation of areas
  int hidden = 0;      ///< number of randomly chosen dots of each robot that are hidden, possibly the centre
};

inline double disc_m2(double radius_m) { return std::numbers::pi * radius_m * radius_m; }

/// The regions of all dots, in random order.
inline std::vector<ProjectedRegion> regions_of(const MarkerLayout& layout,
                                               const std::vector<PlacedRobot>& robots, const Noise& noise,
                                               Rng& rng) {
  std::vector<ProjectedRegion> regions;
  const auto add = [&](Colour colour, const Vec2& position_m, double radius_m) {
    const Vec2 error = noise.sd_m * normal_vector(rng);
    regions.push_back({colour, position_m + error, disc_m2(radius_m) * (1 + noise.area_sd * rng.normal())});
  };
  for (const PlacedRobot& robot : robots) {
    std::vector<bool> is_hidden(layout.dots.size() + 1);
    for (int i = 0; i < noise.hidden;) {
      const std::size_t k = rng.below(is_hidden.size());
      i += is_hidden[k] ? 0 : 1;
      is_hidden[k] = true;
    }
    if (!is_hidden.back())
      add(layout.team_colour(robot.entry.team), robot.pose.to_world(layout.centre.position_m),
          layout.centre.radius_m);
    for (std::size_t k = 0; k < layout.dots.size(); ++k) {
      if (!is_hidden[k])
        add(robot.entry.pattern.colours[k], robot.pose.to_world(layout.dots[k].position_m),
            layout.dots[k].radius_m);
    }
  }
  rng.shuffle(regions);
  return regions;
}

/// Robots of both teams with the layout's first patterns, at random poses more than `min_distance_m` apart.
inline std::vector<PlacedRobot> scattered(const MarkerLayout& layout, std::size_t robots_per_team,
                                          double min_distance_m, Rng& rng) {
  std::vector<PlacedRobot> robots;
  while (robots.size() < 2 * robots_per_team) {
    const std::size_t i = robots.size() % robots_per_team;
    const bool is_blue = robots.size() < robots_per_team;
    const Pose pose{{rng.uniform(-3, 3), rng.uniform(-2, 2)},
                    rng.uniform(-std::numbers::pi, std::numbers::pi)};
    bool is_free = true;
    for (const PlacedRobot& other : robots)
      is_free &= (other.pose.position_m - pose.position_m).norm() > min_distance_m;
    if (!is_free) continue;
    const auto id = static_cast<RobotId>(is_blue ? i : 16 + i);
    robots.push_back({{id, is_blue ? Team::kBlue : Team::kYellow, layout.patterns[i]}, pose});
  }
  return robots;
}

inline std::vector<RosterEntry> roster_of(const std::vector<PlacedRobot>& robots) {
  std::vector<RosterEntry> roster;
  for (const PlacedRobot& robot : robots) roster.push_back(robot.entry);
  return roster;
}

inline std::vector<ExpectedRobot> expected_of(const std::vector<PlacedRobot>& robots) {
  std::vector<ExpectedRobot> expected;
  for (const PlacedRobot& robot : robots) expected.push_back({robot.entry.robot, robot.pose});
  return expected;
}

}  // namespace sidestep::test
