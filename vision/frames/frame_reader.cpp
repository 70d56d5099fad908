// SPDX-License-Identifier: Apache-2.0
#include "vision/frames/frame_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sidestep {
namespace {

// A ball is lit from above: what has its colour is a part of its disc.
constexpr double kLeastBall = 0.25, kMostBall = 2.0;

double confidence_of(const MarkedRobot& robot, const MarkingLayout& layout) {
  return robot.seen / static_cast<double>(layout.dots.size() + 1);
}

}  // namespace

FrameReader::FrameReader(const CameraModel& camera, const FrameTask& task)
    : camera_(camera),
      task_(task),
      segmenter_(ColourClasses(task.boxes)),
      finder_(task.layout),
      identifier_(task.roster) {}

bool FrameReader::is_worn(Colour colour) const {
  return colour == task_.layout.blue_team || colour == task_.layout.yellow_team ||
         std::ranges::any_of(task_.layout.patterns, [&](const MarkingPattern& pattern) {
           return std::ranges::find(pattern.colours, colour) != pattern.colours.end();
         });
}

void FrameReader::read(const ImageView& image, Time captured_at, std::span<const ExpectedRobot> expected,
                       msg::DetectionFrame& frame) {
  regions_ = segmenter_.segment(image);
  patches_.clear();
  for (const Region& region : regions_) {
    const auto colour = static_cast<Colour>(region.colour);
    if (!is_worn(colour)) continue;
    if (const auto patch = patch_of(region, camera_, task_.robot_height_m)) patches_.push_back(*patch);
  }
  robots_ = identifier_.identify(captured_at, finder_.find(patches_), expected);
  frame.captured_at_ns(to_ns(captured_at));
  frame.robots().clear();
  for (const IdentifiedRobot& robot : robots_) {
    msg::RobotDetection seen;
    seen.robot(robot.robot);
    seen.x_m(robot.seen.pose.position_m.x());
    seen.y_m(robot.seen.pose.position_m.y());
    seen.heading_rad(wrapped_rad(robot.seen.pose.heading_rad));
    seen.confidence(confidence_of(robot.seen, task_.layout));
    frame.robots().push_back(seen);
  }
  find_balls(frame);
  find_obstacles(frame);
}

/// Whether a patch at the robots' height is a dot of one that was found: in coloured light it may seem to
/// have another colour.
bool FrameReader::is_dot(const Patch& patch) const {
  const auto is_at = [&](const MarkedRobot& robot, const MarkingDot& dot) {
    return (robot.pose.to_world(dot.position_m) - patch.position_m).norm() < dot.radius_m;
  };
  return std::ranges::any_of(robots_, [&](const IdentifiedRobot& robot) {
    return is_at(robot.seen, task_.layout.centre) ||
           std::ranges::any_of(task_.layout.dots,
                               [&](const MarkingDot& dot) { return is_at(robot.seen, dot); });
  });
}

/// The most likely ones by their size.
void FrameReader::find_balls(msg::DetectionFrame& frame) {
  balls_.clear();
  for (const Region& region : regions_) {
    if (static_cast<Colour>(region.colour) != task_.ball) continue;
    const auto on_top = patch_of(region, camera_, task_.robot_height_m);
    const auto on_floor = patch_of(region, camera_, task_.ball_radius_m);
    if (on_top && on_floor && !is_dot(*on_top)) balls_.push_back(*on_floor);
  }
  const double disc_m2 = std::numbers::pi * task_.ball_radius_m * task_.ball_radius_m;
  std::erase_if(balls_, [&](const Patch& patch) {
    return patch.area_m2 < kLeastBall * disc_m2 || patch.area_m2 > kMostBall * disc_m2;
  });
  const auto surprise = [&](const Patch& patch) { return std::abs(std::log(patch.area_m2 / disc_m2)); };
  std::ranges::sort(balls_, {}, surprise);
  if (balls_.size() > msg::MAX_DETECTED_BALLS) balls_.resize(msg::MAX_DETECTED_BALLS);
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    msg::BallDetection& ball = frame.balls()[i];
    ball.x_m(balls_[i].position_m.x());
    ball.y_m(balls_[i].position_m.y());
    ball.confidence(std::exp(-surprise(balls_[i])));
  }
  frame.ball_count(static_cast<std::uint8_t>(balls_.size()));
}

/// As large on the floor as its bounding box, which nothing of it exceeds.
void FrameReader::find_obstacles(msg::DetectionFrame& frame) const {
  std::uint8_t count = 0;
  for (const Region& region : regions_) {
    const auto colour = static_cast<Colour>(region.colour);
    if (count == msg::MAX_OBSTACLES) break;
    if (is_worn(colour) || colour == task_.ball) continue;
    const auto low = camera_.point_at({region.left_px - 0.5, region.top_px - 0.5}, 0);
    const auto high = camera_.point_at({region.right_px + 0.5, region.bottom_px + 0.5}, 0);
    if (!low || !high) continue;
    const Vec2 middle = 0.5 * (*low + *high);
    const double radius_m = 0.5 * (*high - *low).cwiseAbs().maxCoeff();
    if (radius_m < task_.least_obstacle_m) continue;
    msg::ObstacleDetection& seen = frame.obstacles()[count++];
    seen.x_m(middle.x());
    seen.y_m(middle.y());
    seen.radius_m(radius_m);
  }
  frame.obstacle_count(count);
}

}  // namespace sidestep
