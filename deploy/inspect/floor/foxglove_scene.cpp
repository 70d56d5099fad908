// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/floor/foxglove_scene.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/messaging/version_codec.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::json;

constexpr const char* kFloor = "floor";
constexpr double kRobotHeight_m = 0.15, kPersonHeight_m = 1.7, kBallRadius_m = 0.0215;

Json timestamp(Time now) {
  const std::int64_t ns = to_ns(now);
  return {{"sec", ns / 1'000'000'000}, {"nsec", ns % 1'000'000'000}};
}

Json point(double x_m, double y_m, double z_m) { return {{"x", x_m}, {"y", y_m}, {"z", z_m}}; }

Json turned(double heading_rad) {
  return {{"x", 0}, {"y", 0}, {"z", std::sin(heading_rad / 2)}, {"w", std::cos(heading_rad / 2)}};
}

Json pose(double x_m, double y_m, double z_m, double heading_rad = 0) {
  return {{"position", point(x_m, y_m, z_m)}, {"orientation", turned(heading_rad)}};
}

Json colour(double r, double g, double b, double a) { return {{"r", r}, {"g", g}, {"b", b}, {"a", a}}; }

struct RobotPose {
  double x_m, y_m, heading_rad;
};

/// The robot's pose from ground truth, otherwise from vision, otherwise its own estimate.
std::optional<RobotPose> pose_of(const RobotView& robot, Time now) {
  std::optional<RobotPose> found;
  if (const msg::TrueRobotState* truth = fresh(robot.truth, now))
    found = {truth->x_m(), truth->y_m(), truth->heading_rad()};
  else if (const msg::TrackedRobot* seen = fresh(robot.seen, now))
    found = {seen->x_m(), seen->y_m(), seen->heading_rad()};
  else if (const msg::Feedback* feedback = fresh(robot.feedback, now))
    found = {feedback->x_m(), feedback->y_m(), feedback->heading_rad()};
  // JSON has no NaN.
  if (found && !std::isfinite(found->x_m + found->y_m + found->heading_rad)) return std::nullopt;
  return found;
}

Json cylinder(double x_m, double y_m, double radius_m, double height_m, double heading_rad,
              const Json& tint) {
  return {{"pose", pose(x_m, y_m, height_m / 2, heading_rad)},
          {"size", point(2 * radius_m, 2 * radius_m, height_m)},
          {"bottom_scale", 1},
          {"top_scale", 1},
          {"color", tint}};
}

/// The path on which the robot comes to rest, as a line; null if there is none.
Json stop_line(const msg::Version& message, Time now) {
  constexpr int kPoints = 6;
  const std::optional<Version> version = decode(message);
  if (!version) return nullptr;
  const Trajectory& trajectory = version->trajectory;
  const Time begin = std::max(now, trajectory.start()), end = std::max(begin, trajectory.end());
  Json points = Json::array();
  for (int i = 0; i <= kPoints; ++i) {
    const Vec2 p = trajectory.state_at(begin + (end - begin) * i / kPoints).position_m;
    points.push_back(point(p.x(), p.y(), 0.01));
  }
  return {{"type", 0},  // a line strip
          {"pose", pose(0, 0, 0)},
          {"thickness", 0.03},
          {"scale_invariant", false},
          {"points", points},
          {"color", colour(0, 0.62, 0.45, 0.9)},
          {"colors", Json::array()},
          {"indices", Json::array()}};
}

}  // namespace

Json scene_update(const FloorState& floor, double radius_m, Time now) {
  Json cylinders = Json::array(), lines = Json::array(), spheres = Json::array(), texts = Json::array();
  for (const auto& [id, robot] : floor.robots()) {
    const std::optional<RobotPose> at = pose_of(robot, now);
    if (!at) continue;
    cylinders.push_back(
        cylinder(at->x_m, at->y_m, radius_m, kRobotHeight_m, at->heading_rad, colour(0.34, 0.71, 0.91, 1)));
    texts.push_back({{"pose", pose(at->x_m, at->y_m, 1.5 * kRobotHeight_m)},
                     {"billboard", true},
                     {"font_size", radius_m},
                     {"scale_invariant", false},
                     {"color", colour(1, 1, 1, 1)},
                     {"text", std::to_string(id)}});
    if (const msg::Feedback* feedback = fresh(robot.feedback, now))
      if (Json line = stop_line(feedback->executing(), now); !line.is_null())
        lines.push_back(std::move(line));
  }
  if (const msg::ObstacleList* list = fresh(floor.obstacles(), now))
    for (const msg::TrackedObstacle& o : list->obstacles())
      if (std::isfinite(o.x_m() + o.y_m() + o.radius_m()))
        cylinders.push_back(
            cylinder(o.x_m(), o.y_m(), o.radius_m(), kPersonHeight_m, 0, colour(0.84, 0.37, 0, 0.7)));
  if (const msg::WorldState* world = fresh(floor.world(), now))
    if (world->ball().is_visible() && std::isfinite(world->ball().x_m() + world->ball().y_m()))
      spheres.push_back({{"pose", pose(world->ball().x_m(), world->ball().y_m(), kBallRadius_m)},
                         {"size", point(2 * kBallRadius_m, 2 * kBallRadius_m, 2 * kBallRadius_m)},
                         {"color", colour(1, 0.55, 0.1, 1)}});
  const Json none = Json::array();
  const Json entity{{"timestamp", timestamp(now)},
                    {"frame_id", kFloor},
                    {"id", kFloor},
                    {"lifetime", {{"sec", 0}, {"nsec", 0}}},
                    {"frame_locked", false},
                    {"metadata", none},
                    {"arrows", none},
                    {"cubes", none},
                    {"spheres", spheres},
                    {"cylinders", cylinders},
                    {"lines", lines},
                    {"triangles", none},
                    {"texts", texts},
                    {"models", none}};
  return {{"deletions", none}, {"entities", {entity}}};
}

Json frame_transforms(const FloorState& floor, Time now) {
  Json transforms = Json::array();
  for (const auto& [id, robot] : floor.robots())
    if (const std::optional<RobotPose> at = pose_of(robot, now))
      transforms.push_back({{"timestamp", timestamp(now)},
                            {"parent_frame_id", kFloor},
                            {"child_frame_id", fmt::format("robot {}", id)},
                            {"translation", point(at->x_m, at->y_m, 0)},
                            {"rotation", turned(at->heading_rad)}});
  return {{"transforms", transforms}};
}

}  // namespace sidestep
