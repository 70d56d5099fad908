// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/vision/patch_errors.hpp"

#include <cmath>
#include <optional>

#include "common/marking/butterfly.hpp"
#include "common/marking/pose_error.hpp"
#include "deploy/evaluation/study/vision/hall.hpp"
#include "vision/patterns/patch.hpp"

namespace sidestep {
namespace {

constexpr Field kQuarter{6, 4.5};
constexpr std::size_t kEach = 11, kSceneFrames = 10;
constexpr double kNear_m = 0.012;
constexpr double kDegrees = 57.29577951308232;

/// Of errors per axis, about their mean.
class Spread {
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

/// In robots' own frames.
struct Errors {
  std::vector<Spread> dots{butterfly().dots.size() + 1};
  Spread centroids;
  double square_rad2 = 0;
  std::size_t robots = 0;

  double dot_sd_m() const {
    double sum_m2 = 0;
    for (const Spread& dot : dots) sum_m2 += dot.variance();
    return std::sqrt(sum_m2 / static_cast<double>(dots.size()));
  }
};

Vec2 centroid_of(const MarkingLayout& layout) {
  Vec2 sum = layout.centre.position_m;
  for (const MarkingDot& dot : layout.dots) sum += dot.position_m;
  return sum / static_cast<double>(layout.dots.size() + 1);
}

/// Of the largest patch there: beside it noise makes small ones.
std::optional<Vec2> error_at(const std::vector<Patch>& patches, Colour colour, const Vec2& at_m) {
  const Patch* found = nullptr;
  for (const Patch& patch : patches) {
    const bool is_there = patch.colour == colour && (patch.position_m - at_m).norm() < kNear_m;
    if (is_there && (!found || patch.area_m2 > found->area_m2)) found = &patch;
  }
  return found ? std::optional<Vec2>(found->position_m - at_m) : std::nullopt;
}

/// The errors of a robot's dots, ahead and to its left, all of which the pose has to be from; nothing when
/// one of them is not seen.
std::optional<std::vector<Vec2>> dot_errors(const std::vector<Patch>& patches, const SceneRobot& robot) {
  const MarkingLayout& layout = butterfly();
  const Pose truth{robot.position_m, robot.heading_rad};
  const MarkingPattern& pattern = *layout.find(robot.pattern);
  std::vector<Vec2> errors;
  for (std::size_t i = 0; i <= layout.dots.size(); ++i) {
    const MarkingDot& dot = i == 0 ? layout.centre : layout.dots[i - 1];
    const Colour colour = i == 0 ? layout.team_colour(robot.team) : pattern.colours[i - 1];
    const auto error = error_at(patches, colour, truth.to_world(dot.position_m));
    if (!error) return std::nullopt;
    errors.push_back(rotated(*error, -robot.heading_rad));
  }
  return errors;
}

void add_frame(const Hall& hall, Errors& errors) {
  std::vector<Patch> patches;
  for (const Region& region : hall.reader(0).regions()) {
    if (const auto patch = patch_of(region, hall.camera(0), RobotCylinder{}.height_m))
      patches.push_back(*patch);
  }
  const Vec2 centroid_m = centroid_of(butterfly());
  for (const SceneRobot& robot : hall.robots()) {
    const auto of_dots = dot_errors(patches, robot);
    if (!of_dots) continue;
    for (const msg::RobotDetection& seen : hall.detections().front().robots()) {
      if (seen.robot() != robot_wearing(robot.team, robot.pattern) || seen.confidence() < 1) continue;
      const Pose truth{robot.position_m, robot.heading_rad};
      const Pose pose{{seen.x_m(), seen.y_m()}, seen.heading_rad()};
      const double off_rad = wrapped_rad(pose.heading_rad - truth.heading_rad);
      for (std::size_t i = 0; i < of_dots->size(); ++i) errors.dots[i].add((*of_dots)[i]);
      const Vec2 off_m = pose.to_world(centroid_m) - truth.to_world(centroid_m);
      errors.centroids.add(rotated(off_m, -robot.heading_rad));
      errors.square_rad2 += off_rad * off_rad;
      ++errors.robots;
    }
  }
}

}  // namespace

StudyTable patch_errors(const PatchErrors& settings, std::uint64_t seed, const StudyAdvance& advance) {
  StudyTable table;
  table.name = "patch-errors";
  table.columns = {"noise",        "robots",  "dot_mm",           "centroid_mm",
                   "predicted_mm", "degrees", "predicted_degrees"};
  PlotLine centroids{"centroid, measured", {}}, headings{"heading, measured", {}};
  PlotLine predicted_centroids{"s / sqrt(n)", {}}, predicted_headings{"s / sqrt(sum r^2)", {}};
  std::size_t done = 0;
  Rng rng(seed);
  const Scenario scenario = hall_scenario(kQuarter, 1, 1);
  const ColourThresholds colours = learned_colours(scenario, {}, rng);
  for (const double noise : settings.noises) {
    RenderSpec spec;
    spec.noise = noise;
    Hall hall(scenario, spec, colours, rng);
    Errors errors;
    for (std::size_t frame = 0; frame < settings.frames; ++frame) {
      if (frame % kSceneFrames == 0) hall.clear(kEach);
      hall.step();
      hall.see();
      add_frame(hall, errors);
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
                  .y_label = "of the centroid (mm per axis)",
                  .lines = {centroids, predicted_centroids}},
                 {.title = "Heading",
                  .x_label = "error of a dot (mm per axis)",
                  .y_label = "of the heading (degrees)",
                  .lines = {headings, predicted_headings}}};
  return table;
}

}  // namespace sidestep
