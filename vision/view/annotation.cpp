// SPDX-License-Identifier: Apache-2.0
#include "vision/view/annotation.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "vision/detection/detector.hpp"

namespace sidestep {
namespace {

constexpr int kFractionBits = 4;  // of a pixel, in what OpenCV draws
const Ink kBlueTeam{255, 190, 90}, kYellowTeam{70, 230, 255}, kBall{40, 140, 255}, kObstacle{200, 200, 255};

}  // namespace

std::optional<cv::Point> FloorPen::pixel_of(const Vec2& at_m, double height_m) const {
  const auto pixel = camera_.pixel_of({at_m.x(), at_m.y(), height_m});
  if (!pixel || pixel->cwiseAbs().maxCoeff() > 1e5) return std::nullopt;
  const double scale = 1 << kFractionBits;
  return cv::Point(static_cast<int>(std::lround(pixel->x() * scale)),
                   static_cast<int>(std::lround(pixel->y() * scale)));
}

void FloorPen::circle(const Vec2& centre_m, double height_m, double radius_m, const Ink& ink) {
  constexpr int kCorners = 48;
  std::vector<cv::Point> outline;
  for (int i = 0; i < kCorners; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / kCorners;
    const auto pixel =
        pixel_of(centre_m + radius_m * Vec2(std::cos(angle_rad), std::sin(angle_rad)), height_m);
    if (!pixel) return;
    outline.push_back(*pixel);
  }
  cv::polylines(picture_, outline, true, ink, 1, cv::LINE_AA, kFractionBits);
}

void FloorPen::cross(const Vec2& centre_m, double height_m, double radius_m, const Ink& ink) {
  for (const Vec2& arm : {Vec2(radius_m, 0), Vec2(0, radius_m)})
    line(centre_m - arm, centre_m + arm, height_m, ink);
}

void FloorPen::line(const Vec2& from_m, const Vec2& to_m, double height_m, const Ink& ink) {
  const auto from = pixel_of(from_m, height_m), to = pixel_of(to_m, height_m);
  if (from && to) cv::line(picture_, *from, *to, ink, 1, cv::LINE_AA, kFractionBits);
}

void FloorPen::words(const std::string& text, const Vec2& at_m, double height_m, const Ink& ink) {
  const auto at = pixel_of(at_m, height_m);
  if (!at) return;
  const cv::Point place(at->x >> kFractionBits, at->y >> kFractionBits);
  cv::putText(picture_, text, place, cv::FONT_HERSHEY_SIMPLEX, 0.38, {0, 0, 0}, 3, cv::LINE_AA);
  cv::putText(picture_, text, place, cv::FONT_HERSHEY_SIMPLEX, 0.38, ink, 1, cv::LINE_AA);
}

void draw_detections(const msg::DetectionFrame& seen, const Scenario& scenario, FloorPen& pen) {
  const FrameTask task;
  for (const msg::RobotDetection& robot : seen.robots()) {
    const RobotSpec* const spec = find_robot(scenario, robot.robot());
    const Ink& ink = spec && spec->team == Team::kYellow ? kYellowTeam : kBlueTeam;
    const Vec2 at_m(robot.x_m(), robot.y_m());
    const Vec2 ahead(std::cos(robot.heading_rad()), std::sin(robot.heading_rad()));
    pen.circle(at_m, task.robot_height_m, scenario.radius_m, ink);
    pen.line(at_m, at_m + 1.5 * scenario.radius_m * ahead, task.robot_height_m, ink);
    pen.words(fmt::format("{}", robot.robot()), at_m + Vec2(1.1, 0.9) * scenario.radius_m,
              task.robot_height_m, ink);
  }
  for (std::size_t i = 0; i < seen.ball_count(); ++i) {
    const msg::BallDetection& ball = seen.balls()[i];
    pen.circle({ball.x_m(), ball.y_m()}, task.ball_radius_m, 2 * task.ball_radius_m, kBall);
  }
  for (std::size_t i = 0; i < seen.obstacle_count(); ++i) {
    const msg::ObstacleDetection& obstacle = seen.obstacles()[i];
    pen.circle({obstacle.x_m(), obstacle.y_m()}, 0, obstacle.radius_m(), kObstacle);
  }
}

}  // namespace sidestep
