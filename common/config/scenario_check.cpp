// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_check.hpp"

#include <fmt/format.h>

#include "common/yaml/config_error.hpp"

namespace sidestep {
namespace {

/// Allows for rounding where a file or a generator gives the exact minimum distance.
constexpr double kRounding_m = 1e-9;

struct PlacementCheck {
  const Scenario& scenario;
  const std::string& file;

  void check_workspace(const Vec2& point, int line, const std::string& what) const {
    if (!scenario.field.contains(point, scenario.radius_m - kRounding_m)) {
      throw ConfigError(
          file, line,
          fmt::format("{} ({}, {}) is outside the field: expected |x| <= {:g} and |y| <= {:g}", what,
                      point.x(), point.y(), scenario.field.length_m / 2 - scenario.radius_m,
                      scenario.field.width_m / 2 - scenario.radius_m));
    }
    for (const Shape& obstacle : scenario.obstacles) {
      const double distance = signed_distance(point, obstacle);
      const double min_distance = scenario.radius_m + scenario.margin_m;
      if (distance >= min_distance - kRounding_m) continue;
      const Vec2 centre = centre_m(obstacle);
      throw ConfigError(
          file, line,
          fmt::format(
              "{} ({}, {}) is inside the obstacle at ({:g}, {:g}), or too near: distance from its edge "
              "{:.4f} m, expected at least {:.4f} (robot radius + margin)",
              what, point.x(), point.y(), centre.x(), centre.y(), distance, min_distance));
    }
    check_map(point, line, what);
  }

  void check_map(const Vec2& point, int line, const std::string& what) const {
    const double min_distance = scenario.radius_m + scenario.margin_m;
    if (!scenario.map || !scenario.map->cells().touches(point, point, min_distance - kRounding_m)) return;
    throw ConfigError(
        file, line,
        fmt::format("{} ({}, {}) is in blocked cells of the map, or too near: distance {:.4f} m, "
                    "expected at least {:.4f} (robot radius + margin)",
                    what, point.x(), point.y(), scenario.map->cells().distance_m(point, min_distance),
                    min_distance));
  }

  void check_opponents(const Vec2& point, int line, const std::string& what) const {
    for (const OpponentSpec& opponent : scenario.opponents) {
      const double min_distance = opponent.radius_m + scenario.radius_m + scenario.margin_m;
      const double distance = (point - opponent.path_m.front()).norm();
      if (distance >= min_distance - kRounding_m) continue;
      throw ConfigError(
          file, line,
          fmt::format("{} ({}, {}) overlaps the first point of an opponent: distance {:.4f} m, expected at "
                      "least {:.4f} (both radii + margin)",
                      what, point.x(), point.y(), distance, min_distance));
    }
  }

  /// Throws ConfigError if robots at these positions would overlap. Only then calls `what`, for the message.
  template <typename What>
  void check_distance(const Vec2& a, const Vec2& b, int line, What what) const {
    const double min_distance = 2 * scenario.radius_m + scenario.margin_m;
    const double distance = (a - b).norm();
    if (distance >= min_distance - kRounding_m) return;
    throw ConfigError(file, line,
                      fmt::format("{}: distance {:.4f} m, expected at least {:.4f} (2 radii + margin)",
                                  what(), distance, min_distance));
  }
};

/// The robot's last goal or, without goals, its start. nullopt for an absent robot without goals.
std::optional<Vec2> final_position_m(const RobotSpec& robot) {
  if (!robot.goals.empty()) return robot.goals.back().position_m;
  return robot.is_absent ? std::nullopt : std::optional(robot.start_m);
}

}  // namespace

void check_placement(const Scenario& scenario, const std::vector<RobotLines>& lines,
                     const std::string& file) {
  const PlacementCheck check{scenario, file};
  const auto& robots = scenario.robots;
  for (std::size_t i = 1; i < robots.size(); ++i) {
    if (robots[i].id == robots[i - 1].id) {
      throw ConfigError(file, lines[i].start,
                        fmt::format("robot id {} is used twice, expected once", robots[i].id));
    }
  }
  for (std::size_t i = 0; i < robots.size(); ++i) {
    check.check_workspace(robots[i].start_m, lines[i].start, fmt::format("start of robot {}", robots[i].id));
    if (!robots[i].is_absent) {
      check.check_opponents(robots[i].start_m, lines[i].start,
                            fmt::format("start of robot {}", robots[i].id));
    }
    for (std::size_t g = 0; g < robots[i].goals.size(); ++g) {
      check.check_workspace(robots[i].goals[g].position_m, lines[i].goals[g],
                            fmt::format("goal of robot {}", robots[i].id));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!robots[i].is_absent && !robots[j].is_absent) {
        check.check_distance(robots[i].start_m, robots[j].start_m, lines[i].start, [&] {
          return fmt::format("starts of robots {} and {} overlap", robots[j].id, robots[i].id);
        });
      }
      const auto last_i = final_position_m(robots[i]), last_j = final_position_m(robots[j]);
      if (!last_i || !last_j) continue;
      const int line = robots[i].goals.empty() ? lines[i].start : lines[i].goals.back();
      check.check_distance(*last_i, *last_j, line, [&] {
        return fmt::format("last goals of robots {} and {} overlap", robots[j].id, robots[i].id);
      });
    }
  }
}

}  // namespace sidestep
