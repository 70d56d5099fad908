// SPDX-License-Identifier: Apache-2.0
#include "deploy/camera/frame_command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "common/process/process.hpp"
#include "simulator/images/floor_scene.hpp"
#include "simulator/rendering/frame_renderer.hpp"

namespace sidestep {
namespace {

struct FrameOptions {
  std::string scenario_file, picture_file, layout_file;
  std::size_t camera = 0;
  std::uint64_t seed = 1;
  std::optional<int> width_px, height_px;
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
  ImageSpec images = scenario.vision.images.value_or(ImageSpec());
  images.width_px = options.width_px.value_or(images.width_px);
  images.height_px = options.height_px.value_or(images.height_px);
  const std::vector<CameraModel> cameras = hang_grid(scenario.field, scenario.vision, hanging(images));
  if (options.camera >= cameras.size()) {
    fmt::print(stderr, "sidestep: --camera {}: {} has {} cameras, the first is 0\n", options.camera,
               options.scenario_file, cameras.size());
    return kExitUsage;
  }
  RenderSpec spec;
  spec.format = PixelFormat::kRgb;
  FrameRenderer renderer(cameras[options.camera], scenario.field, layout, spec, Rng(options.seed));
  write_picture(renderer.render(floor_scene(scenario).scene()), options.picture_file);
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
  command->add_option("--width", options->width_px, "of the frame, in pixels [the scenario's]")
      ->check(CLI::Range(16, 8192));
  command->add_option("--height", options->height_px, "of the frame, in pixels [the scenario's]")
      ->check(CLI::Range(16, 8192));
  command->add_option("--seed", options->seed, "of the noise")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->callback([&action, options] { action = [options] { return write_frame(*options); }; });
}

}  // namespace sidestep
