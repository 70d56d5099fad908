// SPDX-License-Identifier: Apache-2.0
#include "vision/detection/detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sidestep {
namespace {

// A ball is lit from above: what has its colour is a part of its disc.
constexpr double kLeastBall = 0.25, kMostBall = 2.0;

/// Dots of one colour are to stay apart.
constexpr SegmentationSettings kSegmentation{3, {0.5, 1}};

double confidence_of(const MarkedRobot& robot, const MarkingLayout& layout) {
  return robot.seen / static_cast<double>(layout.dots.size() + 1);
}

/// The sight of a robot ends so far outside it, and where it was expected it may be missed by so much.
constexpr double kEdge_m = 0.01, kMissed_m = 0.04;

/// Tint moves a colour so far out of its thresholds; the other team's is so many times as far.
constexpr double kTint = 24, kFar = 3;

std::uint32_t bit(Colour colour) { return std::uint32_t{1} << static_cast<std::uint32_t>(colour); }

std::uint32_t worn_by(const MarkingLayout& layout) {
  std::uint32_t colours = bit(layout.blue_team) | bit(layout.yellow_team);
  for (const MarkingPattern& pattern : layout.patterns)
    for (const Colour colour : pattern.colours) colours |= bit(colour);
  return colours;
}

ObstacleRules rules_for(const FrameTask& task) {
  ObstacleRules rules;
  rules.ground = (bit(Colour::kField) | bit(Colour::kWhite) | bit(Colour::kBlack)) & ~worn_by(task.layout);
  rules.largest_dot_m = std::max(task.layout.centre.radius_m, task.ball_radius_m);
  for (const MarkingDot& dot : task.layout.dots)
    rules.largest_dot_m = std::max(rules.largest_dot_m, dot.radius_m);
  rules.least_radius_m = task.least_obstacle_m;
  rules.robot_height_m = task.robot_height_m;
  rules.known = task.known_obstacles;
  return rules;
}

}  // namespace

Detector::Detector(const CameraModel& camera, const FrameTask& task)
    : camera_(camera),
      task_(task),
      segmenter_(ColourClasses(task.boxes), kSegmentation),
      finder_(task.layout),
      identifier_(task.roster),
      worn_(worn_by(task.layout)),
      obstacle_finder_(camera, rules_for(task)) {}

void Detector::read(const ImageView& image, Time captured_at, std::span<const ExpectedRobot> expected,
                       msg::DetectionFrame& frame) {
  frame.captured_at_ns(to_ns(captured_at));
  regions_ = segmenter_.segment(image);
  find_robots(image, captured_at, expected, frame);
  find_obstacles(image, expected, frame);
  find_balls(frame);
}

/// Of U and V from what thresholds call this colour.
double Detector::distance_from(Colour colour, const Vec2& uv) const {
  double least = std::numeric_limits<double>::infinity();
  for (const ColourBox& box : task_.boxes) {
    if (box.colour != static_cast<std::uint32_t>(colour)) continue;
    const Vec2 low(box.low.u, box.low.v), high(box.high.u, box.high.v);
    least = std::min(least, (uv - uv.cwiseMax(low).cwiseMin(high)).norm());
  }
  return least;
}

/// The team of a robot whose other dots were found, and whose centre has neither team's colour, as light's
/// tint may have it: the one whose colour it nearly has, when the other's is far.
std::optional<Team> Detector::team_at(const ImageView& image, const Vec2& centre_m) const {
  const auto at = camera_.pixel_of({centre_m.x(), centre_m.y(), task_.robot_height_m});
  if (!at) return std::nullopt;
  const auto x = static_cast<int>(std::lround(at->x())), y = static_cast<int>(std::lround(at->y()));
  if (x < 1 || y < 1 || x + 1 >= image.width_px || y + 1 >= image.height_px) return std::nullopt;
  Vec2 uv(0, 0);
  for (int i = 0; i < 9; ++i) {
    const Yuv pixel = pixel_at(image, x - 1 + i % 3, y - 1 + i / 3);
    uv += Vec2(pixel.u, pixel.v) / 9;
  }
  const double blue = distance_from(task_.layout.blue_team, uv);
  const double yellow = distance_from(task_.layout.yellow_team, uv);
  if (std::min(blue, yellow) > kTint || std::max(blue, yellow) < kFar * std::min(blue, yellow))
    return std::nullopt;
  return blue < yellow ? Team::kBlue : Team::kYellow;
}

void Detector::find_robots(const ImageView& image, Time captured_at,
                              std::span<const ExpectedRobot> expected, msg::DetectionFrame& frame) {
  patches_.clear();
  for (const Region& region : regions_) {
    if ((worn_ >> region.colour & 1) == 0) continue;
    if (const auto patch = patch_of(region, camera_, task_.robot_height_m)) patches_.push_back(*patch);
  }
  const auto found = finder_.find(patches_);
  marked_.assign(found.begin(), found.end());
  for (MarkedRobot& robot : marked_) {
    if (!robot.team) robot.team = team_at(image, robot.pose.to_world(task_.layout.centre.position_m));
  }
  robots_ = identifier_.identify(captured_at, marked_, expected);
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
}

/// Whether a patch at the robots' height is a dot of one that was found: in coloured light it may seem to
/// have another colour.
bool Detector::is_dot(const Patch& patch) const {
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
void Detector::find_balls(msg::DetectionFrame& frame) {
  balls_.clear();
  for (const Region& region : regions_) {
    if (static_cast<Colour>(region.colour) != task_.ball || obstacle_finder_.is_part(region)) continue;
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

/// On robots that were found, or are expected though they were not, there are none.
void Detector::find_obstacles(const ImageView& image, std::span<const ExpectedRobot> expected,
                                 msg::DetectionFrame& frame) {
  feet_.clear();
  for (const MarkedRobot& robot : marked_)
    feet_.push_back({robot.pose.position_m, task_.robot_radius_m + kEdge_m});
  for (const ExpectedRobot& robot : expected) {
    if (std::ranges::find(robots_, robot.robot, &IdentifiedRobot::robot) == robots_.end())
      feet_.push_back({robot.pose.position_m, task_.robot_radius_m + kMissed_m});
  }
  std::uint8_t count = 0;
  for (const Circle& found : obstacle_finder_.find(image, segmenter_.classes(), regions_, feet_)) {
    if (count == msg::MAX_OBSTACLES) break;
    msg::ObstacleDetection& seen = frame.obstacles()[count++];
    seen.x_m(found.centre_m.x());
    seen.y_m(found.centre_m.y());
    seen.radius_m(found.radius_m);
  }
  frame.obstacle_count(count);
}

}  // namespace sidestep
