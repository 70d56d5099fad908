// SPDX-License-Identifier: Apache-2.0
#include "tests/study/vision/recognition.hpp"

#include <algorithm>
#include <cmath>

#include "tests/study/vision/vision_testbed.hpp"
#include "vision/colours/default_colours.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kCoverFrames = 50, kUncoveredFrames = 20;
constexpr double kMatchTolerance_m = 0.03;  // a detection farther from its robot is misidentified

struct Condition {
  const char* name;
  std::size_t robots_per_team;
  int covered_dots = 0;
  double far_light = RenderSpec{}.far_light;
  Eigen::Vector3d colour_gain{1, 1, 1};
  bool is_learned = true;  ///< true: thresholds learned before colours drift; false: default thresholds
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
  std::size_t robots = 0, found = 0, misidentified = 0;
  double square_m2 = 0, square_rad2 = 0;
  std::vector<double> errors_m{};

  void add(const std::vector<SceneRobot>& truth, const msg::DetectionFrame& frame) {
    robots += truth.size();
    for (const msg::RobotDetection& detection : frame.robots()) {
      bool is_correct = false;
      for (const SceneRobot& robot : truth) {
        const double error_m = (robot.position_m - Vec2(detection.x_m(), detection.y_m())).norm();
        if (robot_with_pattern(robot.team, robot.pattern) != detection.robot() || error_m > kMatchTolerance_m)
          continue;
        const double error_rad = wrapped_rad(detection.heading_rad() - robot.heading_rad);
        is_correct = true;
        square_m2 += error_m * error_m;
        square_rad2 += error_rad * error_rad;
        errors_m.push_back(error_m);
      }
      ++(is_correct ? found : misidentified);
    }
  }
};

/// Cumulative distribution of position errors.
PlotLine distribution_of(const Condition& condition, const std::vector<double>& ascending_m) {
  PlotLine line{fmt::format("{}{}, {}", condition.is_learned ? "" : "default: ", condition.name,
                            2 * condition.robots_per_team),
                {}};
  constexpr std::size_t kPoints = 50;
  for (std::size_t i = 0; i <= kPoints && !ascending_m.empty(); ++i) {
    const std::size_t index = std::min(ascending_m.size() - 1, ascending_m.size() * i / kPoints);
    line.points.push_back(
        plot_point(1e3 * ascending_m[index], 100 * static_cast<double>(i) / static_cast<double>(kPoints)));
  }
  return line;
}

Score score_of(const Condition& condition, const Recognition& settings, Rng& rng,
               const std::function<void()>& advance) {
  const Scenario scenario = testbed_scenario(kQuarterField, 1, 1);
  RenderSpec spec;
  spec.exposure_s = 0.004;
  spec.far_light = condition.far_light;
  const ColourThresholds colours =
      condition.is_learned ? learned_colours(scenario, spec, rng) : default_colours(spec.format);
  spec.colour_gain = condition.colour_gain;  // drifts after learning
  VisionTestbed testbed(scenario, spec, colours, rng);
  Score score;
  for (std::size_t frame = 0; frame < settings.frames; ++frame) {
    if (frame % settings.frames_per_scene == 0) {
      testbed.reset(condition.robots_per_team);
      // All robots must be identified once before their dots are covered.
      for (std::size_t i = 0; condition.covered_dots > 0 && i < kUncoveredFrames; ++i) {
        testbed.step();
        testbed.run_vision();
      }
    }
    if (frame % kCoverFrames == 0) testbed.cover_dots(condition.covered_dots);
    testbed.step();
    testbed.run_vision();
    score.add(testbed.robots(), testbed.detections().front());
    advance();
  }
  return score;
}

}  // namespace

StudyTable recognition(const Recognition& settings, std::uint64_t seed, const ProgressCallback& advance) {
  StudyTable table;
  table.name = "recognition";
  table.columns = {"colours",       "light",  "robots", "frames",     "found_percent",
                   "misidentified", "rms_mm", "max_mm", "rms_degrees"};
  Plot plot{.title = "Positions",
            .x_label = "error at most (mm)",
            .y_label = "share of detections (percent)",
            .lines = {}};
  std::size_t done = 0;
  Rng rng(seed);
  for (const Condition& condition : kConditions) {
    Score score = score_of(condition, settings, rng,
                           [&] { advance(++done, settings.frames * std::size(kConditions)); });
    std::ranges::sort(score.errors_m);
    plot.lines.push_back(distribution_of(condition, score.errors_m));
    const auto found = static_cast<double>(std::max<std::size_t>(1, score.found));
    table.rows.push_back(
        cells(colours_of(condition), condition.name, 2 * condition.robots_per_team, settings.frames,
              fmt::format("{:.3f}", 100 * found / static_cast<double>(score.robots)), score.misidentified,
              fmt::format("{:.3f}", 1e3 * std::sqrt(score.square_m2 / found)),
              fmt::format("{:.2f}", 1e3 * (score.errors_m.empty() ? 0 : score.errors_m.back())),
              fmt::format("{:.3f}", kDegrees * std::sqrt(score.square_rad2 / found))));
  }
  table.plots = {plot};
  return table;
}

}  // namespace sidestep
