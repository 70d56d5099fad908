// SPDX-License-Identifier: Apache-2.0
#include "deploy/camera/frame_command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "common/process/process.hpp"
#include "simulator/rendering/frame_renderer.hpp"

namespace sidestep {
namespace {

constexpr Rgb kOpponent{118, 44, 150};

struct FrameOptions {
  std::string scenario_file, picture_file, layout_file;
  std::size_t camera = 0;
  std::uint64_t seed = 1;
  HangingCamera like;
};

void write_picture(const Image& image, const std::string& path) {
  const ImageView view = image.view();
  const cv::Mat rgb(view.height_px, view.width_px, CV_8UC3, const_cast<std::uint8_t*>(view.pixels));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  bool is_written = false;
  try {
    is_written = cv::imwrite(path, bgr);
  } catch (const cv::Exception&) {
    // Said below: OpenCV names its own source file.
  }
  if (!is_written) throw std::runtime_error("cannot write " + path);
}

int write_frame(const FrameOptions& options) {
  const Scenario scenario = load_scenario(options.scenario_file);
  const MarkingLayout layout = options.layout_file.empty() ? butterfly() : load_layout(options.layout_file);
  const std::vector<CameraModel> cameras = hang_grid(scenario.field, scenario.vision, options.like);
  if (options.camera >= cameras.size()) {
    fmt::print(stderr, "sidestep: --camera {}: {} has {} cameras, the first is 0\n", options.camera,
               options.scenario_file, cameras.size());
    return kExitUsage;
  }
  std::vector<SceneRobot> robots;
  for (const RobotSpec& robot : scenario.robots) {
    if (robot.is_absent) continue;
    const std::uint32_t pattern = layout.patterns[robot.id % layout.patterns.size()].id;
    robots.push_back({robot.team, pattern, robot.start_m, robot.start_heading_rad});
  }
  std::vector<SceneBlob> blobs;
  for (const Circle& circle : scenario.obstacles) blobs.push_back({circle});
  for (const OpponentSpec& opponent : scenario.opponents)
    blobs.push_back({{opponent.way_m.front(), opponent.radius_m}, 0.15, kOpponent});
  Scene scene{robots, blobs};
  if (scenario.ball) {
    const Vec2& p = scenario.ball->position_m;
    scene.ball = SceneBall{Vec3(p.x(), p.y(), SceneBall{}.position_m.z())};
  }
  RenderSpec spec;
  spec.format = PixelFormat::kRgb;
  FrameRenderer renderer(cameras[options.camera], scenario.field, layout, spec, Rng(options.seed));
  write_picture(renderer.render(scene), options.picture_file);
  return 0;
}

}  // namespace

void add_frame_command(CLI::App& root, std::function<int()>& action) {
  CLI::App* command =
      root.add_subcommand("frame", "Draws what a camera sees of a scenario's floor at the beginning");
  const auto options = std::make_shared<FrameOptions>();
  command->add_option("SCENARIO", options->scenario_file, "scenario file, see deploy/scenarios/README.md")
      ->required();
  command->add_option("PICTURE", options->picture_file, "file to write")
      ->required()
      ->check([](const std::string& path) {
        return path.ends_with(".png") ? std::string() : "expected a name that ends in .png";
      });
  command->add_option("--camera", options->camera, "which of the scenario's")->capture_default_str();
  command->add_option("--layout", options->layout_file, "layout of the robots' markings [the butterfly]");
  command->add_option("--width", options->like.width_px, "of the frame, in pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  command->add_option("--height", options->like.height_px, "of the frame, in pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the noise")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->callback([&action, options] { action = [options] { return write_frame(*options); }; });
}

}  // namespace sidestep
