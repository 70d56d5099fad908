// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/camera/frame_command.hpp"

#include <cmath>
#include <csignal>
#include <fmt/format.h>
#include <memory>
#include <numbers>
#include <optional>

#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "common/image/picture.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "common/motion/rolling_ball.hpp"
#include "common/process/command_line.hpp"
#include "common/process/help/page_path.hpp"
#include "common/process/process.hpp"
#include "simulator/images/floor_scene.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "vision/colours/default_colours.hpp"
#include "vision/images/image_reader.hpp"
#include "vision/view/annotation.hpp"

namespace sidestep {
namespace {

struct FrameOptions {
  std::string scenario_file, picture_file, layout_file;
  std::size_t camera = 0;
  std::uint64_t seed = 1;
  std::optional<int> width_px, height_px;
  bool shows_detections = false;
};

const Ink kTruth{255, 255, 255};
constexpr double kCrossRadius_m = 0.03;

/// Draws the true positions and, on top, the detections made with default colours. Returns a text with their
/// errors.
std::string overlay(const Image& image, const CameraModel& camera, const Scenario& scenario,
                    const MarkerLayout& layout, cv::Mat3b& picture) {
  const FloorScene floor = floor_scene(scenario);
  Detector detector(camera,
                    detector_settings(scenario, default_colours(image.view().format, layout).boxes, layout));
  msg::DetectionFrame frame;
  detector.detect(image.view(), {}, {}, frame);
  FloorPen pen(picture, camera);
  for (const SceneRobot& robot : floor.robots)
    pen.cross(robot.position_m, kRobotHeight_m, kCrossRadius_m, kTruth);
  for (const SceneCylinder& cylinder : floor.cylinders)
    pen.cross(cylinder.circle.centre_m, 0, cylinder.circle.radius_m, kTruth);
  if (floor.ball) pen.cross(floor.ball->position_m.head<2>(), RollingBall::kRadius_m, kCrossRadius_m, kTruth);
  draw_detections(frame, scenario, pen);
  std::string text;
  for (const msg::RobotDetection& robot : frame.robots()) {
    const RobotSpec& truth = *find_robot(scenario, robot.robot());
    text += fmt::format(
        "robot {}: error {:.2f} mm, {:.2f} degrees\n", robot.robot(),
        1e3 * (truth.start_m - Vec2(robot.x_m(), robot.y_m())).norm(),
        std::abs(wrapped_rad(robot.heading_rad() - truth.start_heading_rad)) * 180 / std::numbers::pi);
  }
  return text + fmt::format("{} robots, {} balls and {} unknown obstacles detected\n", frame.robots().size(),
                            frame.ball_count(), frame.obstacle_count());
}

int write_frame(const FrameOptions& options) {
  // The picture is written even if the reader of the output disappears.
  std::signal(SIGPIPE, SIG_IGN);
  const Scenario scenario = load_scenario(options.scenario_file);
  const MarkerLayout layout = options.layout_file.empty() ? butterfly() : load_layout(options.layout_file);
  ImageSpec images = scenario.vision.images.value_or(ImageSpec{.format = PixelFormat::kRgb});
  images.width_px = options.width_px.value_or(images.width_px);
  images.height_px = options.height_px.value_or(images.height_px);
  const std::vector<CameraModel> cameras =
      camera_grid(scenario.field, scenario.vision, overhead_camera_of(images));
  if (options.camera >= cameras.size()) {
    fmt::print(stderr, "sidestep: --camera: expected 0 to {}, the cameras of {}, got {}\n",
               cameras.size() - 1, options.scenario_file, options.camera);
    return kExitUsage;
  }
  require_replaceable(options.picture_file);
  const CameraModel& camera = cameras[options.camera];
  RenderSpec spec;
  spec.format = images.format;
  FrameRenderer renderer(camera, scenario.field, layout, spec, Rng(options.seed), static_scene(scenario));
  const Image image = renderer.render(floor_scene(scenario).scene());
  cv::Mat3b picture = bgr_of(image.view());
  int error = 0;
  if (options.shows_detections) error = write_text(stdout, overlay(image, camera, scenario, layout, picture));
  write_png(picture, options.picture_file);
  require_printed(error);
  return 0;
}

}  // namespace

void add_frame_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand command =
      root.add_subcommand("frame", "Renders a camera's view of a scenario's floor at the start");
  const auto options = std::make_shared<FrameOptions>();
  command
      .add_option("SCENARIO", options->scenario_file,
                  "scenario file, see " + page_path("deploy/scenarios/README.md"))
      .required();
  command.add_option("PICTURE", options->picture_file, "file to write; an earlier file is replaced")
      .required()
      .check([](const std::string& path) {
        return path.ends_with(".png") ? std::string() : "expected a name that ends in .png";
      });
  command.add_option("--camera", options->camera, "number of the camera, from 0").show_default();
  command.add_option("--layout", options->layout_file, "layout of the robots' markers [the butterfly]");
  command.add_option("--width", options->width_px, "width of the frame in pixels [the scenario's]")
      .check(in_range(16, 8192));
  command.add_option("--height", options->height_px, "height of the frame in pixels [the scenario's]")
      .check(in_range(16, 8192));
  command.add_flag("--detections", options->shows_detections, "draw the detections and the ground truth");
  command.add_option("--seed", options->seed, "seed of the sensor noise")
      .check(non_negative())
      .show_default();
  command.on_parsed([&action, options] { action = [options] { return write_frame(*options); }; });
}

}  // namespace sidestep
