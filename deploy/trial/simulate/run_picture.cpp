// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/run_picture.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>

#include "deploy/trial/shape_picture.hpp"
#include "deploy/trial/simulate/floor_picture.hpp"

namespace sidestep {
namespace {

constexpr double kOutlinePeriod_s = 0.25;
constexpr double kFrame_s = 0.05, kPause_s = 1.5;  ///< step of the animation, and pause at its end
constexpr double kMaxFrames = 400;

/// SVG's y axis points down.
std::string circle(const Vec2& centre_m, double radius_m, const std::string& style) {
  return svg_disc(centre_m, radius_m, style, kPixelsPerMetre);
}

/// Opponents follow their paths regardless of the robots, so their paths are drawn as specified.
std::string path_of(const OpponentSpec& opponent) {
  std::string points;
  for (const Vec2& point : opponent.path_m) {
    points += fmt::format("{:.1f},{:.1f} ", kPixelsPerMetre * point.x(), -kPixelsPerMetre * point.y());
  }
  return fmt::format(
             "<polyline points='{}' fill='none' stroke='#cf222e' stroke-width='3' stroke-dasharray='12 "
             "12'/>\n",
             points) +
         circle(opponent.path_m.front(), opponent.radius_m, "fill='#cf222e' fill-opacity='0.7'");
}

}  // namespace

void RunPicture::add(const msg::GroundTruth& truth) {
  for (const msg::TrueRobotState& robot : truth.robots()) {
    tracks_[robot.robot()].push_back(
        {static_cast<double>(truth.valid_at_ns()) * 1e-9, {robot.x_m(), robot.y_m()}});
  }
}

std::string RunPicture::track(const RobotSpec& robot, const std::vector<TrackPoint>& points) const {
  const char* colour = colour_of(robot.team);
  std::string line, outlines;
  const double begin_s = points.front().at_s, end_s = points.back().at_s;
  double next_outline_s = begin_s;
  Vec2 last = points.front().position_m;
  for (const TrackPoint& point : points) {
    if (line.empty() || (point.position_m - last).norm() > 0.005) {
      line += fmt::format("{:.1f},{:.1f} ", kPixelsPerMetre * point.position_m.x(),
                          -kPixelsPerMetre * point.position_m.y());
    }
    if (point.at_s >= next_outline_s && (point.position_m - last).norm() > 0.005) {
      const double age = (point.at_s - begin_s) / std::max(0.1, end_s - begin_s);
      outlines +=
          circle(point.position_m, scenario_.radius_m,
                 fmt::format("fill='none' stroke='{}' stroke-opacity='{:.2f}'", colour, 0.15 + 0.35 * age));
      next_outline_s = point.at_s + kOutlinePeriod_s;
    }
    last = point.position_m;
  }
  return outlines +
         fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='3'/>\n", line, colour);
}

std::string RunPicture::animation(const std::vector<TrackPoint>& points, double begin_s, double end_s) const {
  const double frame_s = std::max(kFrame_s, (end_s - begin_s) / kMaxFrames);
  const Vec2 drawn_at_m = points.back().position_m;
  std::string offsets;
  auto point = points.begin();
  for (double at_s = begin_s; at_s < end_s + kPause_s; at_s += frame_s) {
    while (std::next(point) != points.end() && std::next(point)->at_s <= at_s) ++point;
    offsets += fmt::format("{:.0f},{:.0f};", kPixelsPerMetre * (point->position_m.x() - drawn_at_m.x()),
                           kPixelsPerMetre * (drawn_at_m.y() - point->position_m.y()));
  }
  return fmt::format(
      "<animateTransform attributeName='transform' type='translate' values='{}0,0' dur='{:.2f}s' "
      "repeatCount='indefinite'/>\n",
      offsets, end_s + kPause_s - begin_s);
}

std::string RunPicture::svg() const {
  double begin_s = std::numeric_limits<double>::infinity(), end_s = 0;
  for (const auto& [robot, points] : tracks_) {
    begin_s = std::min(begin_s, points.front().at_s);
    end_s = std::max(end_s, points.back().at_s);
  }
  std::string svg = svg_floor(scenario_);
  for (const OpponentSpec& opponent : scenario_.opponents) svg += path_of(opponent);
  std::string ends;
  for (const RobotSpec& robot : scenario_.robots) {
    const auto found = tracks_.find(robot.id);
    if (found == tracks_.end()) continue;
    svg += track(robot, found->second);
    ends += "<g>" + svg_robot(scenario_, robot, found->second.back().position_m) +
            animation(found->second, begin_s, end_s) + "</g>\n";
  }
  return svg + ends + "</svg>\n";
}

}  // namespace sidestep
