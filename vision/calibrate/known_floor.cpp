// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/known_floor.hpp"

#include <cmath>
#include <set>

#include "vision/colours/known_discs.hpp"
#include "vision/detection/detector.hpp"
#include "vision/patterns/patch.hpp"

namespace sidestep {
namespace {

/// As high as everything on the floor is taken to be.
const double kTop_m = FrameTask{}.robot_height_m;

/// Something upright, from its foot to its top; also when its middle is outside the image.
void hide(const CameraModel& camera, const Circle& circle, std::vector<KnownDisc>& discs) {
  for (const double height_m : {0.0, kTop_m}) {
    const Vec3 centre_m(circle.centre_m.x(), circle.centre_m.y(), height_m);
    const auto pixel = camera.pixel_of(centre_m);
    const auto covered = px2_per_m2(camera, centre_m);
    if (pixel && covered) discs.push_back({{}, *pixel, circle.radius_m * std::sqrt(*covered)});
  }
}

}  // namespace

KnownFloor floor_at_start(const Scenario& scenario, const MarkingLayout& layout, const CameraModel& camera) {
  KnownFloor floor;
  for (const RobotSpec& robot : scenario.robots) {
    if (robot.is_absent) continue;
    const Pose pose{robot.start_m, robot.start_heading_rad};
    const auto dots = seen_dots(camera, layout, robot.team, pattern_of(layout, robot.id), pose, kTop_m);
    floor.discs.insert(floor.discs.end(), dots.begin(), dots.end());
  }
  if (scenario.ball) {
    const double radius_m = FrameTask{}.ball_radius_m;
    const Vec2& at_m = scenario.ball->position_m;
    const auto disc = seen_disc(camera, FrameTask{}.ball, {at_m.x(), at_m.y(), radius_m}, radius_m);
    if (disc) floor.discs.push_back(*disc);
  }
  for (const Circle& obstacle : scenario.obstacles) hide(camera, obstacle, floor.unknown);
  for (const OpponentSpec& opponent : scenario.opponents)
    hide(camera, {opponent.path_m.front(), opponent.radius_m}, floor.unknown);
  return floor;
}

std::vector<Colour> colours_at_start(const Scenario& scenario, const MarkingLayout& layout) {
  std::set<Colour> colours;
  for (const RobotSpec& robot : scenario.robots) {
    if (robot.is_absent) continue;
    const MarkingPattern& pattern = pattern_of(layout, robot.id);
    colours.insert(layout.team_colour(robot.team));
    colours.insert(pattern.colours.begin(), pattern.colours.end());
  }
  if (scenario.ball) colours.insert(FrameTask{}.ball);
  return {colours.begin(), colours.end()};
}

}  // namespace sidestep
