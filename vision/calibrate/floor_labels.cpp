// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/floor_labels.hpp"

#include <cmath>
#include <set>

#include "common/motion/rolling_ball.hpp"
#include "vision/colours/labelled_discs.hpp"
#include "vision/detection/detector.hpp"
#include "vision/patterns/projected_region.hpp"

namespace sidestep {
namespace {

/// Adds discs for the base and the top of a vertical cylinder that is as high as a robot, even if a disc's
/// centre is outside the image.
void add_cylinder(const CameraModel& camera, const Circle& circle, std::vector<LabelledDisc>& discs) {
  for (const double height_m : {0.0, kRobotHeight_m}) {
    const Vec3 centre_m(circle.centre_m.x(), circle.centre_m.y(), height_m);
    const auto pixel = camera.pixel_of(centre_m);
    const auto scale = px2_per_m2(camera, centre_m);
    if (pixel && scale) discs.push_back({{}, *pixel, circle.radius_m * std::sqrt(*scale)});
  }
}

}  // namespace

FloorLabels floor_labels_at_start(const Scenario& scenario, const MarkerLayout& layout,
                                  const CameraModel& camera) {
  FloorLabels labels;
  for (const RobotSpec& robot : scenario.robots) {
    if (robot.is_absent) continue;
    const Pose pose{robot.start_m, robot.start_heading_rad};
    const auto dots =
        projected_dots(camera, layout, robot.team, pattern_of(layout, robot.id), pose, kRobotHeight_m);
    labels.discs.insert(labels.discs.end(), dots.begin(), dots.end());
  }
  if (scenario.ball) {
    const double radius_m = RollingBall::kRadius_m;
    const Vec2& position_m = scenario.ball->position_m;
    const auto disc =
        projected_disc(camera, kBallColour, {position_m.x(), position_m.y(), radius_m}, radius_m);
    if (disc) labels.discs.push_back(*disc);
  }
  for (const Circle& obstacle : circles_of(scenario.obstacles))
    add_cylinder(camera, obstacle, labels.ignored);
  for (const OpponentSpec& opponent : scenario.opponents)
    add_cylinder(camera, {opponent.path_m.front(), opponent.radius_m}, labels.ignored);
  return labels;
}

std::vector<Colour> colours_at_start(const Scenario& scenario, const MarkerLayout& layout) {
  std::set<Colour> colours;
  for (const RobotSpec& robot : scenario.robots) {
    if (robot.is_absent) continue;
    const MarkerPattern& pattern = pattern_of(layout, robot.id);
    colours.insert(layout.team_colour(robot.team));
    colours.insert(pattern.colours.begin(), pattern.colours.end());
  }
  if (scenario.ball) colours.insert(kBallColour);
  return {colours.begin(), colours.end()};
}

}  // namespace sidestep
