// SPDX-License-Identifier: Apache-2.0
#include "tests/study/vision/vision_testbed.hpp"

#include <bit>

#include "common/camera/camera_grid.hpp"
#include "common/marking/butterfly.hpp"
#include "vision/calibrate/learn_colours.hpp"
#include "vision/colours/default_colours.hpp"
#include "vision/colours/labelled_discs.hpp"

namespace sidestep {
namespace {

constexpr double kPeriod_s = 1.0 / 60;
constexpr std::uint64_t kDots = 5;

}  // namespace

Scenario testbed_scenario(const Field& field, int columns, int rows) {
  Scenario scenario;
  scenario.field = field;
  scenario.vision.columns = columns;
  scenario.vision.rows = rows;
  scenario.vision.overlap_m = columns * rows > 1 ? 0.25 : 0;
  scenario.vision.images.emplace();
  for (const Team team : {Team::kBlue, Team::kYellow}) {
    for (std::uint32_t pattern = 0; pattern < 16; ++pattern)
      scenario.robots.push_back({robot_with_pattern(team, pattern), team, {0, 0}, 0, {}});
  }
  return scenario;
}

VisionTestbed::VisionTestbed(const Scenario& scenario, const RenderSpec& spec,
                             const ColourThresholds& colours, Rng& rng)
    : rng_(rng.fork()), scenario_(scenario), reader_(scenario, camera_grid(scenario), colours, butterfly()) {
  for (const CameraModel& camera : camera_grid(scenario))
    renderers_.emplace_back(camera, scenario.field, butterfly(), spec, Rng(rng_.bits()));
  const ImageSpec& images = scenario.vision.images.value();
  for (std::uint32_t camera = 0; camera < renderers_.size(); ++camera) {
    msg::CameraImage& image = images_.emplace_back();
    image.camera(camera);
    image.image_format(spec.format == PixelFormat::kRgb ? msg::ImageFormat::IMAGE_RGB
                                                        : msg::ImageFormat::IMAGE_YUV422);
    image.width_px(static_cast<std::uint32_t>(images.width_px));
    image.height_px(static_cast<std::uint32_t>(images.height_px));
    image.pixels().resize(ImageView{spec.format, images.width_px, images.height_px}.bytes());
  }
  detections_.resize(renderers_.size());
}

void VisionTestbed::reset(std::size_t robots_per_team) {
  oscillating_.emplace(scenario_.field, robots_per_team, rng_);
  tracker_.emplace(tracker_settings(scenario_), roster_of(scenario_));
  world_ = {};
  time_s_ += 10;
  hidden_dots_.assign(2 * robots_per_team, 0);
}

void VisionTestbed::cover_dots(int dots) {
  for (std::uint32_t& hidden : hidden_dots_) {
    hidden = 0;
    while (std::popcount(hidden) < dots) hidden |= std::uint32_t{1} << rng_.below(kDots);
  }
}

void VisionTestbed::step() {
  time_s_ += kPeriod_s;
  robots_ = oscillating_->robots_at(time_s_);
  for (std::size_t i = 0; i < robots_.size(); ++i) robots_[i].hidden_dots = hidden_dots_[i];
  ball_ = oscillating_->ball_at(time_s_);
  const Scene scene{robots_, {}, ball_};
  for (std::size_t camera = 0; camera < renderers_.size(); ++camera) {
    renderers_[camera].render(scene, images_[camera].pixels().data());
    images_[camera].captured_at_ns(to_ns(Time(from_seconds(time_s_))));
  }
}

void VisionTestbed::run_vision() {
  for (std::size_t camera = 0; camera < images_.size(); ++camera) {
    const Time captured_at = time_from_ns(images_[camera].captured_at_ns());
    reader_.read(images_[camera], captured_at, world_, detections_[camera]);
    frame_.assign(detections_[camera], captured_at);
    tracker_->update(frame_);
  }
  tracker_->world_at(time_from_ns(images_.front().captured_at_ns()), world_);
}

ColourThresholds learned_colours(const Scenario& scenario, const RenderSpec& spec, Rng& rng) {
  constexpr std::size_t kScenes = 5;
  VisionTestbed testbed(scenario, spec, default_colours(spec.format), rng);
  std::vector<msg::CameraImage> images;
  std::vector<FloorLabels> labels;
  for (std::size_t i = 0; i < kScenes; ++i) {
    testbed.reset(kRobotsPerTeam);
    testbed.step();
    for (const msg::CameraImage& image : testbed.images()) {
      const CameraModel& camera = testbed.camera(image.camera());
      FloorLabels& floor = labels.emplace_back();
      for (const SceneRobot& robot : testbed.robots()) {
        const auto dots = projected_dots(camera, butterfly(), robot.team, *butterfly().find(robot.pattern),
                                         {robot.position_m, robot.heading_rad}, RobotCylinder().height_m);
        floor.discs.insert(floor.discs.end(), dots.begin(), dots.end());
      }
      const SceneBall& ball = testbed.ball();
      const auto disc = projected_disc(camera, Colour::kOrange, ball.position_m, ball.position_m.z());
      if (disc) floor.discs.push_back(*disc);
      images.push_back(image);
    }
  }
  std::vector<LabelledImage> labelled;
  for (std::size_t i = 0; i < images.size(); ++i)
    labelled.push_back({view_of(images[i], testbed.camera(images[i].camera())).value(), labels[i]});
  const Colour expected[] = {Colour::kBlue, Colour::kYellow, Colour::kPink, Colour::kGreen, Colour::kOrange};
  return learn_colours(labelled, expected).thresholds;
}

}  // namespace sidestep
