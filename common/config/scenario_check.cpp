// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_check.hpp"

#include <fmt/format.h>

#include "common/yaml/config_error.hpp"

namespace sidestep {
namespace {

/// Allows for rounding where a file or a generator gives the exact minimum distance.
constexpr double kRounding_m = 1e-9;

/// The robot's last goal or, without goals, its start. nullopt for an absent robot without goals.
std::optional<Vec2> final_position_m(const RobotSpec& robot) {
  if (!robot.goals.empty()) return robot.goals.back().position_m;
  return robot.is_absent ? std::nullopt : std::optional(robot.start_m);
}

/// The line that gives this position.
int final_line(const RobotLines& lines) { return lines.goals.empty() ? lines.start : lines.goals.back(); }

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

  /// Throws ConfigError if two robots would overlap in the end, with the line of the second.
  void check_final_positions(const RobotSpec& first, const RobotSpec& second, const RobotLines& first_lines,
                             const RobotLines& second_lines) const {
    const auto a = final_position_m(first), b = final_position_m(second);
    if (!a || !b) return;
    check_distance(*a, *b, final_line(second_lines), [&] {
      if (!first.goals.empty() && !second.goals.empty())
        return fmt::format("last goals of robots {} and {} overlap", first.id, second.id);
      const bool first_stays = first.goals.empty();
      const RobotSpec &staying = first_stays ? first : second, &driving = first_stays ? second : first;
      const RobotLines &staying_lines = first_stays ? first_lines : second_lines,
                       &driving_lines = first_stays ? second_lines : first_lines;
      return fmt::format(
          "the last goal of robot {} (line {}) overlaps the start of robot {} (line {}), which has "
          "no goals and stays there",
          driving.id, final_line(driving_lines), staying.id, final_line(staying_lines));
    });
  }
};

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
      check.check_final_positions(robots[j], robots[i], lines[j], lines[i]);
    }
  }
}

}  // namespace sidestep
