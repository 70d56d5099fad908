// SPDX-License-Identifier: Apache-2.0
#include "tests/study/vision/marker_errors.hpp"

#include <cmath>
#include <optional>

#include "common/marking/butterfly.hpp"
#include "common/marking/pose_error.hpp"
#include "tests/study/vision/vision_testbed.hpp"
#include "vision/patterns/projected_region.hpp"

namespace sidestep {
namespace {

constexpr double kMaxDotError_m = 0.012;

/// Standard deviation of errors about their mean, per axis.
class ErrorDeviation {
 public:
  void add(const Vec2& error) {
    ++count_;
    sum_ += error;
    square_ += error.squaredNorm();
  }
  double variance() const {
    const auto n = static_cast<double>(count_);
    return (square_ / n - (sum_ / n).squaredNorm()) / 2;
  }
  double sd() const { return std::sqrt(variance()); }

 private:
  std::size_t count_ = 0;
  Vec2 sum_{0, 0};
  double square_ = 0;
};

/// Errors of dots in the robots' frames.
struct Errors {
  std::vector<ErrorDeviation> dots{butterfly().dots.size() + 1};
  ErrorDeviation centroids;
  double square_rad2 = 0;
  std::size_t robots = 0;

  double dot_sd_m() const {
    double sum_m2 = 0;
    for (const ErrorDeviation& dot : dots) sum_m2 += dot.variance();
    return std::sqrt(sum_m2 / static_cast<double>(dots.size()));
  }
};

Vec2 centroid_of(const MarkerLayout& layout) {
  Vec2 sum = layout.centre.position_m;
  for (const Marker& dot : layout.dots) sum += dot.position_m;
  return sum / static_cast<double>(layout.dots.size() + 1);
}

/// Position error of the largest region of a colour near a dot; noise creates small regions beside it.
std::optional<Vec2> error_at(const std::vector<ProjectedRegion>& regions, Colour colour, const Vec2& true_m) {
  const ProjectedRegion* largest = nullptr;
  for (const ProjectedRegion& region : regions) {
    const bool matches = region.colour == colour && (region.position_m - true_m).norm() < kMaxDotError_m;
    if (matches && (!largest || region.area_m2 > largest->area_m2)) largest = &region;
  }
  return largest ? std::optional<Vec2>(largest->position_m - true_m) : std::nullopt;
}

/// The errors of all dots of a robot in its frame; empty if a dot was not found.
std::optional<std::vector<Vec2>> dot_errors(const std::vector<ProjectedRegion>& regions,
                                            const SceneRobot& robot) {
  const MarkerLayout& layout = butterfly();
  const Pose truth{robot.position_m, robot.heading_rad};
  const MarkerPattern& pattern = *layout.find(robot.pattern);
  std::vector<Vec2> errors;
  for (std::size_t i = 0; i <= layout.dots.size(); ++i) {
    const Marker& dot = i == 0 ? layout.centre : layout.dots[i - 1];
    const Colour colour = i == 0 ? layout.team_colour(robot.team) : pattern.colours[i - 1];
    const auto error = error_at(regions, colour, truth.to_world(dot.position_m));
    if (!error) return std::nullopt;
    errors.push_back(rotated(*error, -robot.heading_rad));
  }
  return errors;
}

void add_frame(const VisionTestbed& testbed, Errors& errors) {
  std::vector<ProjectedRegion> regions;
  for (const Region& region : testbed.detector(0).regions()) {
    if (const auto projected = project_region(region, testbed.camera(0), RobotCylinder{}.height_m))
      regions.push_back(*projected);
  }
  const Vec2 centroid_m = centroid_of(butterfly());
  for (const SceneRobot& robot : testbed.robots()) {
    const auto of_dots = dot_errors(regions, robot);
    if (!of_dots) continue;
    for (const msg::RobotDetection& detection : testbed.detections().front().robots()) {
      if (detection.robot() != robot_with_pattern(robot.team, robot.pattern) || detection.confidence() < 1)
        continue;
      const Pose truth{robot.position_m, robot.heading_rad};
      const Pose pose{{detection.x_m(), detection.y_m()}, detection.heading_rad()};
      const double error_rad = wrapped_rad(pose.heading_rad - truth.heading_rad);
      for (std::size_t i = 0; i < of_dots->size(); ++i) errors.dots[i].add((*of_dots)[i]);
      const Vec2 error_m = pose.to_world(centroid_m) - truth.to_world(centroid_m);
      errors.centroids.add(rotated(error_m, -robot.heading_rad));
      errors.square_rad2 += error_rad * error_rad;
      ++errors.robots;
    }
  }
}

}  // namespace

StudyTable marker_errors(const MarkerErrors& settings, std::uint64_t seed, const ProgressCallback& advance) {
  StudyTable table;
  table.name = "marker-errors";
  table.columns = {"noise",        "robots",  "dot_mm",           "centroid_mm",
                   "predicted_mm", "degrees", "predicted_degrees"};
  PlotLine centroids{"centroid, measured", {}}, headings{"heading, measured", {}};
  PlotLine predicted_centroids{"s / sqrt(n)", {}}, predicted_headings{"s / sqrt(sum r^2)", {}};
  std::size_t done = 0;
  Rng rng(seed);
  const Scenario scenario = testbed_scenario(kQuarterField, 1, 1);
  const ColourThresholds colours = learned_colours(scenario, {}, rng);
  for (const double noise : settings.noises) {
    RenderSpec spec;
    spec.noise = noise;
    VisionTestbed testbed(scenario, spec, colours, rng);
    Errors errors;
    for (std::size_t frame = 0; frame < settings.frames; ++frame) {
      if (frame % settings.frames_per_scene == 0) testbed.reset(kRobotsPerTeam);
      testbed.step();
      testbed.run_vision();
      add_frame(testbed, errors);
      advance(++done, settings.frames * settings.noises.size());
    }
    const double dot_m = errors.dot_sd_m();
    const PoseError predicted = predicted_pose_error(butterfly(), dot_m);
    const double heading_rad =
        std::sqrt(errors.square_rad2 / static_cast<double>(std::max<std::size_t>(1, errors.robots)));
    const auto in = [](double value, double unit) { return fmt::format("{:.4f}", value * unit); };
    table.rows.push_back(cells(noise, errors.robots, in(dot_m, 1e3), in(errors.centroids.sd(), 1e3),
                               in(predicted.centroid_m, 1e3), in(heading_rad, kDegrees),
                               in(predicted.heading_rad, kDegrees)));
    centroids.points.push_back(plot_point(1e3 * dot_m, 1e3 * errors.centroids.sd()));
    predicted_centroids.points.push_back(plot_point(1e3 * dot_m, 1e3 * predicted.centroid_m));
    headings.points.push_back(plot_point(1e3 * dot_m, kDegrees * heading_rad));
    predicted_headings.points.push_back(plot_point(1e3 * dot_m, kDegrees * predicted.heading_rad));
  }
  table.plots = {{.title = "Position",
                  .x_label = "error of a dot (mm per axis)",
                  .y_label = "error of the centroid (mm per axis)",
                  .lines = {centroids, predicted_centroids}},
                 {.title = "Heading",
                  .x_label = "error of a dot (mm per axis)",
                  .y_label = "error of the heading (degrees)",
                  .lines = {headings, predicted_headings}}};
  return table;
}

}  // namespace sidestep
