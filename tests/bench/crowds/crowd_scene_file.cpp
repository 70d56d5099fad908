// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_scene_file.hpp"

#include <fmt/format.h>
#include <stdexcept>
#include <variant>

namespace sidestep {
namespace {

std::string text_of(const Vec2& point_m) { return fmt::format("[{}, {}]", point_m.x(), point_m.y()); }

std::string text_of(const Shape& obstacle) {
  if (const auto* circle = std::get_if<Circle>(&obstacle))
    return fmt::format("{{circle: {{centre_m: {}, radius_m: {}}}}}", text_of(circle->centre_m),
                       circle->radius_m);
  if (const auto* box = std::get_if<Box>(&obstacle))
    return fmt::format("{{box: {{min_m: {}, max_m: {}}}}}", text_of(box->min_m), text_of(box->max_m));
  throw std::invalid_argument("a crowd scene has an obstacle that is neither a circle nor a box");
}

std::string text_of(const RobotSpec& robot) {
  std::string goals;
  for (const Goal& goal : robot.goals) goals += (goals.empty() ? "" : ", ") + text_of(goal.position_m);
  return fmt::format("{{id: {}, team: {}, start_m: {}, heading_rad: {}, goals_m: [{}]}}", robot.id,
                     robot.team == Team::kBlue ? "blue" : "yellow", text_of(robot.start_m),
                     robot.start_heading_rad, goals);
}

}  // namespace

std::optional<std::string> crowd_scene_file(const Scenario& scene) {
  for (const RobotSpec& robot : scene.robots)
    for (const Goal& goal : robot.goals)
      if (goal.speed_limit_mps) return std::nullopt;
  std::string file = fmt::format("field: {{length_m: {}, width_m: {}}}\ntime_limit_s: {}\n",
                                 scene.field.length_m, scene.field.width_m, scene.time_limit_s);
  if (!scene.obstacles.empty()) file += "obstacles:\n";
  for (const Shape& obstacle : scene.obstacles) file += "  - " + text_of(obstacle) + "\n";
  file += "robots:\n";
  for (const RobotSpec& robot : scene.robots) file += "  - " + text_of(robot) + "\n";
  return file;
}

}  // namespace sidestep
