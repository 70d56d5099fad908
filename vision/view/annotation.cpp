// SPDX-License-Identifier: Apache-2.0
#include "vision/view/annotation.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "common/motion/rolling_ball.hpp"
#include "vision/detection/detector.hpp"

namespace sidestep {
namespace {

constexpr int kFractionBits = 4;  // fixed-point bits of pixel coordinates passed to OpenCV
const Ink kBlueTeam{255, 190, 90}, kYellowTeam{70, 230, 255}, kBall{40, 140, 255}, kObstacle{200, 200, 255};

}  // namespace

std::optional<cv::Point> FloorPen::pixel_of(const Vec2& position_m, double height_m) const {
  const auto pixel = camera_.pixel_of({position_m.x(), position_m.y(), height_m});
  if (!pixel || pixel->cwiseAbs().maxCoeff() > 1e5) return std::nullopt;
  const double scale = 1 << kFractionBits;
  return cv::Point(static_cast<int>(std::lround(pixel->x() * scale)),
                   static_cast<int>(std::lround(pixel->y() * scale)));
}

void FloorPen::circle(const Vec2& centre_m, double height_m, double radius_m, const Ink& ink) {
  constexpr int kCorners = 48;
  std::vector<cv::Point> polygon;
  for (int i = 0; i < kCorners; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / kCorners;
    const auto pixel =
        pixel_of(centre_m + radius_m * Vec2(std::cos(angle_rad), std::sin(angle_rad)), height_m);
    if (!pixel) return;
    polygon.push_back(*pixel);
  }
  cv::polylines(picture_, polygon, true, ink, 1, cv::LINE_AA, kFractionBits);
}

void FloorPen::cross(const Vec2& centre_m, double height_m, double radius_m, const Ink& ink) {
  for (const Vec2& arm : {Vec2(radius_m, 0), Vec2(0, radius_m)})
    line(centre_m - arm, centre_m + arm, height_m, ink);
}

void FloorPen::line(const Vec2& from_m, const Vec2& to_m, double height_m, const Ink& ink) {
  const auto from = pixel_of(from_m, height_m), to = pixel_of(to_m, height_m);
  if (from && to) cv::line(picture_, *from, *to, ink, 1, cv::LINE_AA, kFractionBits);
}

void FloorPen::text(const std::string& text, const Vec2& position_m, double height_m, const Ink& ink) {
  const auto pixel = pixel_of(position_m, height_m);
  if (!pixel) return;
  const cv::Point origin(pixel->x >> kFractionBits, pixel->y >> kFractionBits);
  cv::putText(picture_, text, origin, cv::FONT_HERSHEY_SIMPLEX, 0.38, {0, 0, 0}, 3, cv::LINE_AA);
  cv::putText(picture_, text, origin, cv::FONT_HERSHEY_SIMPLEX, 0.38, ink, 1, cv::LINE_AA);
}

void draw_detections(const msg::DetectionFrame& frame, const Scenario& scenario, FloorPen& pen) {
  for (const msg::RobotDetection& robot : frame.robots()) {
    const RobotSpec* const spec = find_robot(scenario, robot.robot());
    const Ink& ink = spec && spec->team == Team::kYellow ? kYellowTeam : kBlueTeam;
    const Vec2 position_m(robot.x_m(), robot.y_m());
    const Vec2 direction(std::cos(robot.heading_rad()), std::sin(robot.heading_rad()));
    pen.circle(position_m, kRobotHeight_m, scenario.radius_m, ink);
    pen.line(position_m, position_m + 1.5 * scenario.radius_m * direction, kRobotHeight_m, ink);
    pen.text(fmt::format("{}", robot.robot()), position_m + Vec2(1.1, 0.9) * scenario.radius_m,
             kRobotHeight_m, ink);
  }
  for (std::size_t i = 0; i < frame.ball_count(); ++i) {
    const msg::BallDetection& ball = frame.balls()[i];
    pen.circle({ball.x_m(), ball.y_m()}, RollingBall::kRadius_m, 2 * RollingBall::kRadius_m, kBall);
  }
  for (std::size_t i = 0; i < frame.obstacle_count(); ++i) {
    const msg::ObstacleDetection& obstacle = frame.obstacles()[i];
    pen.circle({obstacle.x_m(), obstacle.y_m()}, 0, obstacle.radius_m(), kObstacle);
  }
}

}  // namespace sidestep
