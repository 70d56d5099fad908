// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/vision/recognition.hpp"

#include <algorithm>
#include <cmath>

#include "deploy/evaluation/study/vision/hall.hpp"
#include "vision/colours/default_colours.hpp"

namespace sidestep {
namespace {

constexpr Field kQuarter{6, 4.5};
constexpr std::size_t kSceneFrames = 250, kCoverFrames = 50, kBareFrames = 20;
constexpr double kSame_m = 0.03;  // who is seen farther from where it is is somebody else
constexpr double kDegrees = 57.29577951308232;

struct Condition {
  const char* name;
  std::size_t each;  ///< robots of each team
  int covered = 0;
  double far_light = RenderSpec{}.far_light;
  Eigen::Vector3d colour_gain{1, 1, 1};
  bool is_learned = true;  ///< thresholds, before colours drift; else they are the default ones
};

const Condition kConditions[] = {
    {"usual", 6},
    {"usual", 11},
    {"one dot covered", 11, 1},
    {"light to 60 %", 11, 0, 0.6},
    {"drift by 10 %", 11, 0, RenderSpec{}.far_light, {1.1, 0.95, 0.9}},
    {"both", 11, 0, 0.6, {1.1, 0.95, 0.9}},
    {"usual", 11, 0, RenderSpec{}.far_light, {1, 1, 1}, false},
    {"both", 11, 0, 0.6, {1.1, 0.95, 0.9}, false},
};

const char* colours_of(const Condition& condition) { return condition.is_learned ? "learned" : "default"; }

struct Score {
  std::size_t robots = 0, found = 0, wrong = 0;
  double square_m2 = 0, square_rad2 = 0;
  std::vector<double> offs_m{};

  void add(const std::vector<SceneRobot>& truth, const msg::DetectionFrame& seen) {
    robots += truth.size();
    for (const msg::RobotDetection& detection : seen.robots()) {
      bool is_right = false;
      for (const SceneRobot& robot : truth) {
        const double off_m = (robot.position_m - Vec2(detection.x_m(), detection.y_m())).norm();
        if (robot_wearing(robot.team, robot.pattern) != detection.robot() || off_m > kSame_m) continue;
        const double off_rad = wrapped_rad(detection.heading_rad() - robot.heading_rad);
        is_right = true;
        square_m2 += off_m * off_m;
        square_rad2 += off_rad * off_rad;
        offs_m.push_back(off_m);
      }
      ++(is_right ? found : wrong);
    }
  }
};

/// The share of sights that are off by no more.
PlotLine shares_of(const Condition& condition, const std::vector<double>& ascending_m) {
  PlotLine line{
      fmt::format("{}{}, {}", condition.is_learned ? "" : "default: ", condition.name, 2 * condition.each),
      {}};
  constexpr std::size_t kPoints = 50;
  for (std::size_t i = 0; i <= kPoints && !ascending_m.empty(); ++i) {
    const std::size_t place = std::min(ascending_m.size() - 1, ascending_m.size() * i / kPoints);
    line.points.push_back(
        plot_point(1e3 * ascending_m[place], 100 * static_cast<double>(i) / static_cast<double>(kPoints)));
  }
  return line;
}

Score score_of(const Condition& condition, std::size_t frames, Rng& rng,
               const std::function<void()>& advance) {
  const Scenario scenario = hall_scenario(kQuarter, 1, 1);
  RenderSpec spec;
  spec.exposure_s = 0.004;
  spec.far_light = condition.far_light;
  const ColourThresholds colours =
      condition.is_learned ? learned_colours(scenario, spec, rng) : default_colours(spec.format);
  spec.colour_gain = condition.colour_gain;  // drifts after that
  Hall hall(scenario, spec, colours, rng);
  Score score;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    if (frame % kSceneFrames == 0) {
      hall.clear(condition.each);
      // Everybody is seen once before something is put on the dots.
      for (std::size_t i = 0; condition.covered > 0 && i < kBareFrames; ++i) {
        hall.step();
        hall.see();
      }
    }
    if (frame % kCoverFrames == 0) hall.cover(condition.covered);
    hall.step();
    hall.see();
    score.add(hall.robots(), hall.detections().front());
    advance();
  }
  return score;
}

}  // namespace

StudyTable recognition(const Recognition& settings, std::uint64_t seed, const StudyAdvance& advance) {
  StudyTable table;
  table.name = "recognition";
  table.columns = {"colours", "light",  "robots",   "frames",     "found_percent",
                   "wrong",   "rms_mm", "worst_mm", "rms_degrees"};
  Plot plot{.title = "Positions",
            .x_label = "off by at most (mm)",
            .y_label = "share of sights (percent)",
            .lines = {}};
  std::size_t done = 0;
  Rng rng(seed);
  for (const Condition& condition : kConditions) {
    Score score = score_of(condition, settings.frames, rng,
                           [&] { advance(++done, settings.frames * std::size(kConditions)); });
    std::ranges::sort(score.offs_m);
    plot.lines.push_back(shares_of(condition, score.offs_m));
    const auto found = static_cast<double>(std::max<std::size_t>(1, score.found));
    table.rows.push_back(cells(colours_of(condition), condition.name, 2 * condition.each, settings.frames,
                               fmt::format("{:.3f}", 100 * found / static_cast<double>(score.robots)),
                               score.wrong, fmt::format("{:.3f}", 1e3 * std::sqrt(score.square_m2 / found)),
                               fmt::format("{:.2f}", 1e3 * (score.offs_m.empty() ? 0 : score.offs_m.back())),
                               fmt::format("{:.3f}", kDegrees * std::sqrt(score.square_rad2 / found))));
  }
  table.plots = {plot};
  return table;
}

}  // namespace sidestep
