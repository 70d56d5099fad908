// SPDX-License-Identifier: Apache-2.0
#include "vision/detection/detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/messaging/detected_obstacles.hpp"
#include "common/motion/rolling_ball.hpp"

namespace sidestep {
namespace {

constexpr double kMinObstacleRadius_m = 0.03;

// Lit from above, a ball shows its colour on only part of its disc.
constexpr double kMinBallAreaRatio = 0.25, kMaxBallAreaRatio = 2.0;

// Dots of one colour must not be merged, so the merge gap is small.
constexpr SegmentationSettings kSegmentation{3, 1};

double confidence_of(const DetectedPattern& pattern, const MarkerLayout& layout) {
  return pattern.dot_count / static_cast<double>(layout.dots.size() + 1);
}

// Pixels within a robot's radius plus this margin are attributed to the robot, if it was found, or expected
// but not found.
constexpr double kFoundRobotMargin_m = 0.01, kMissedRobotMargin_m = 0.04;

// A tinted centre may be outside its team's thresholds by at most this distance in U and V, if the other
// team's thresholds are at least this many times as far away.
constexpr double kMaxTeamDistance = 24, kMinTeamDistanceRatio = 3;

std::uint32_t bit(Colour colour) { return std::uint32_t{1} << static_cast<std::uint32_t>(colour); }

std::uint32_t colours_of(const MarkerLayout& layout) {
  std::uint32_t colours = bit(layout.blue_team) | bit(layout.yellow_team);
  for (const MarkerPattern& pattern : layout.patterns)
    for (const Colour colour : pattern.colours) colours |= bit(colour);
  return colours;
}

ObstacleFinderSettings obstacle_finder_settings(const DetectorSettings& settings) {
  ObstacleFinderSettings result;
  result.ground_colours =
      (bit(Colour::kField) | bit(Colour::kWhite) | bit(Colour::kBlack)) & ~colours_of(settings.layout);
  result.max_dot_radius_m = std::max(settings.layout.centre.radius_m, RollingBall::kRadius_m);
  for (const Marker& dot : settings.layout.dots)
    result.max_dot_radius_m = std::max(result.max_dot_radius_m, dot.radius_m);
  result.min_radius_m = kMinObstacleRadius_m;
  result.known_obstacles = settings.known_obstacles;
  result.known_map = settings.known_map;
  return result;
}

}  // namespace

Detector::Detector(const CameraModel& camera, const DetectorSettings& settings)
    : camera_(camera),
      settings_(settings),
      segmenter_(ColourClasses(settings.boxes), kSegmentation),
      pattern_finder_(settings.layout),
      identifier_(settings.roster),
      marking_colours_(colours_of(settings.layout)),
      obstacle_finder_(camera, obstacle_finder_settings(settings)) {}

void Detector::detect(const ImageView& image, Time captured_at, std::span<const ExpectedRobot> expected,
                      msg::DetectionFrame& frame) {
  frame.captured_at_ns(to_ns(captured_at));
  regions_ = segmenter_.segment(image);
  find_robots(image, captured_at, expected, frame);
  find_obstacles(image, expected, frame);
  find_balls(frame);
}

/// Distance of U and V from the nearest box of a colour.
double Detector::chroma_distance(Colour colour, const Vec2& uv) const {
  double min_distance = std::numeric_limits<double>::infinity();
  for (const ColourBox& box : settings_.boxes) {
    if (box.colour != static_cast<std::uint32_t>(colour)) continue;
    const Vec2 low(box.low.u, box.low.v), high(box.high.u, box.high.v);
    min_distance = std::min(min_distance, (uv - uv.cwiseMax(low).cwiseMin(high)).norm());
  }
  return min_distance;
}

/// The team of a pattern whose centre dot is missing because tinted light has moved its colour out of the
/// team's thresholds. It is the team whose colour is near, provided that the other team's colour is far.
std::optional<Team> Detector::team_by_chroma(const ImageView& image, const Vec2& centre_m) const {
  const auto centre = camera_.pixel_of({centre_m.x(), centre_m.y(), kRobotHeight_m});
  if (!centre) return std::nullopt;
  const auto x = static_cast<int>(std::lround(centre->x())), y = static_cast<int>(std::lround(centre->y()));
  if (x < 1 || y < 1 || x + 1 >= image.width_px || y + 1 >= image.height_px) return std::nullopt;
  Vec2 uv(0, 0);
  for (int i = 0; i < 9; ++i) {
    const Yuv pixel = pixel_at(image, x - 1 + i % 3, y - 1 + i / 3);
    uv += Vec2(pixel.u, pixel.v) / 9;
  }
  const double blue = chroma_distance(settings_.layout.blue_team, uv);
  const double yellow = chroma_distance(settings_.layout.yellow_team, uv);
  if (std::min(blue, yellow) > kMaxTeamDistance ||
      std::max(blue, yellow) < kMinTeamDistanceRatio * std::min(blue, yellow))
    return std::nullopt;
  return blue < yellow ? Team::kBlue : Team::kYellow;
}

void Detector::find_robots(const ImageView& image, Time captured_at, std::span<const ExpectedRobot> expected,
                           msg::DetectionFrame& frame) {
  dot_regions_.clear();
  for (const Region& region : regions_) {
    if ((marking_colours_ >> region.colour & 1) == 0) continue;
    if (const auto projected = project_region(region, camera_, kRobotHeight_m))
      dot_regions_.push_back(*projected);
  }
  const auto found = pattern_finder_.find(dot_regions_);
  patterns_.assign(found.begin(), found.end());
  for (DetectedPattern& pattern : patterns_) {
    if (!pattern.team)
      pattern.team = team_by_chroma(image, pattern.pose.to_world(settings_.layout.centre.position_m));
  }
  robots_ = identifier_.identify(captured_at, patterns_, expected);
  frame.robots().clear();
  for (const IdentifiedRobot& robot : robots_) {
    msg::RobotDetection detection;
    detection.robot(robot.robot);
    detection.x_m(robot.pattern.pose.position_m.x());
    detection.y_m(robot.pattern.pose.position_m.y());
    detection.heading_rad(wrapped_rad(robot.pattern.pose.heading_rad));
    detection.confidence(confidence_of(robot.pattern, settings_.layout));
    frame.robots().push_back(detection);
  }
}

/// Whether a region at the robots' height is a dot of an identified robot, which in tinted light may appear
/// in another colour.
bool Detector::is_robot_dot(const ProjectedRegion& region) const {
  const auto is_at = [&](const DetectedPattern& pattern, const Marker& dot) {
    return (pattern.pose.to_world(dot.position_m) - region.position_m).norm() < dot.radius_m;
  };
  return std::ranges::any_of(robots_, [&](const IdentifiedRobot& robot) {
    return is_at(robot.pattern, settings_.layout.centre) ||
           std::ranges::any_of(settings_.layout.dots,
                               [&](const Marker& dot) { return is_at(robot.pattern, dot); });
  });
}

/// Lists as balls the regions whose area is nearest to a ball's.
void Detector::find_balls(msg::DetectionFrame& frame) {
  ball_regions_.clear();
  for (const Region& region : regions_) {
    if (static_cast<Colour>(region.colour) != kBallColour || obstacle_finder_.is_part_of_obstacle(region))
      continue;
    const auto at_robot_height = project_region(region, camera_, kRobotHeight_m);
    const auto at_ball_height = project_region(region, camera_, RollingBall::kRadius_m);
    if (at_robot_height && at_ball_height && !is_robot_dot(*at_robot_height))
      ball_regions_.push_back(*at_ball_height);
  }
  const double disc_m2 = std::numbers::pi * RollingBall::kRadius_m * RollingBall::kRadius_m;
  std::erase_if(ball_regions_, [&](const ProjectedRegion& region) {
    return region.area_m2 < kMinBallAreaRatio * disc_m2 || region.area_m2 > kMaxBallAreaRatio * disc_m2;
  });
  const auto log_area_error = [&](const ProjectedRegion& region) {
    return std::abs(std::log(region.area_m2 / disc_m2));
  };
  std::ranges::sort(ball_regions_, {}, log_area_error);
  if (ball_regions_.size() > msg::MAX_DETECTED_BALLS) ball_regions_.resize(msg::MAX_DETECTED_BALLS);
  for (std::size_t i = 0; i < ball_regions_.size(); ++i) {
    msg::BallDetection& ball = frame.balls()[i];
    ball.x_m(ball_regions_[i].position_m.x());
    ball.y_m(ball_regions_[i].position_m.y());
    ball.confidence(std::exp(-log_area_error(ball_regions_[i])));
  }
  frame.ball_count(static_cast<std::uint8_t>(ball_regions_.size()));
}

/// Ignores pixels on robots that were found, and on robots that were expected but not found.
void Detector::find_obstacles(const ImageView& image, std::span<const ExpectedRobot> expected,
                              msg::DetectionFrame& frame) {
  footprints_.clear();
  for (const DetectedPattern& pattern : patterns_)
    footprints_.push_back({pattern.pose.position_m, settings_.robot_radius_m + kFoundRobotMargin_m});
  for (const ExpectedRobot& robot : expected) {
    if (std::ranges::find(robots_, robot.robot, &IdentifiedRobot::robot) == robots_.end())
      footprints_.push_back({robot.pose.position_m, settings_.robot_radius_m + kMissedRobotMargin_m});
  }
  set_obstacles(obstacle_finder_.find(image, segmenter_.classes(), regions_, footprints_), frame);
  if (obstacle_finder_.has_overflowed()) frame.obstacles_complete_within_m(0);
}

}  // namespace sidestep
