// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/calibrate_command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

#include "vision/cameras/camera_file.hpp"
#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/image/picture.hpp"
#include "common/image/pixel_writing.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "common/process/process.hpp"
#include "vision/calibrate/learn_colours.hpp"

namespace sidestep {
namespace {

constexpr const char* kName = "sidestep-vision calibrate";

struct CalibrateOptions {
  std::string scenario_file, cameras_file, layout_file, format, out_file;
  std::vector<std::string> frame_files;
  std::vector<std::uint32_t> cameras{0};
};

/// The camera of a picture: of the file, or hung over the field for pictures of this size.
CameraModel camera_of(const CalibrateOptions& options, std::uint32_t number, const Scenario& scenario,
                      const ImageView& picture, const std::string& picture_file) {
  if (options.cameras_file.empty()) {
    ImageSpec images = scenario.vision.images.value_or(ImageSpec());
    images.width_px = picture.width_px;
    images.height_px = picture.height_px;
    const std::vector<CameraModel> cameras = hang_grid(scenario.field, scenario.vision, hanging(images));
    if (number < cameras.size()) return cameras[number];
    throw std::invalid_argument(fmt::format("--camera {}: {} has {} cameras, the first is 0", number,
                                            options.scenario_file, cameras.size()));
  }
  const std::vector<NumberedCamera> cameras = load_cameras(options.cameras_file);
  const auto camera = std::ranges::find(cameras, number, &NumberedCamera::id);
  if (camera == cameras.end())
    throw std::invalid_argument(
        fmt::format("--camera {}: {} has no camera of this id", number, options.cameras_file));
  const CameraParameters& p = camera->parameters;
  if (p.width_px != picture.width_px || p.height_px != picture.height_px)
    throw std::invalid_argument(fmt::format(
        "{}: expected {} x {} pixels, as camera {} of {} has, got {} x {}", picture_file, p.width_px,
        p.height_px, number, options.cameras_file, picture.width_px, picture.height_px));
  return CameraModel(p);
}

PixelFormat format_of(const CalibrateOptions& options, const Scenario& scenario) {
  if (!options.format.empty()) return *pixel_format_named(options.format);
  return scenario.vision.images.value_or(ImageSpec()).format;
}

Image read_frame(const std::string& path, PixelFormat format) {
  const Image picture = read_picture(path);
  if (format == PixelFormat::kYuv422 && picture.view().width_px % 2 != 0)
    throw std::invalid_argument(fmt::format("{}: is {} pixels wide, expected an even number with yuv422",
                                            path, picture.view().width_px));
  return written_as(format, picture.view());
}

void write_out(const std::string& text, const std::string& path) {
  if (path.empty()) {
    fmt::print("{}", text);
    return;
  }
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

/// Says what was learned. False when that is not what the scenario says.
bool report(const LearnedColours& learned) {
  bool is_there = true;
  for (const LearnedColour& one : learned.colours) {
    fmt::print(stderr, "{}: {:<7} {:6} pixels, {:.1f} % told\n", kName, named(one.colour).name, one.pixels,
               100 * one.told);
    is_there &= one.pixels == 0 || one.told > 0.5;
  }
  for (const std::string& warning : learned.warnings) fmt::print(stderr, "{}: warning: {}\n", kName, warning);
  return is_there;
}

int calibrate(const CalibrateOptions& options) {
  const std::size_t count = options.frame_files.size();
  if (options.cameras.size() != 1 && options.cameras.size() != count)
    throw std::invalid_argument(fmt::format("--camera: expected one number, or {} for as many frames, got {}",
                                            count, options.cameras.size()));
  const Scenario scenario = load_scenario(options.scenario_file);
  const MarkingLayout layout = options.layout_file.empty() ? butterfly() : load_layout(options.layout_file);
  const std::vector<Colour> expected = colours_at_start(scenario, layout);
  std::vector<Image> images;
  std::vector<KnownImage> known;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& path = options.frame_files[i];
    const std::uint32_t number = options.cameras[options.cameras.size() > 1 ? i : 0];
    images.push_back(read_frame(path, format_of(options, scenario)));
    const ImageView view = images.back().view();
    known.push_back(
        {view, floor_at_start(scenario, layout, camera_of(options, number, scenario, view, path))});
    if (known.back().floor.discs.empty())
      throw std::invalid_argument(
          fmt::format("{}: camera {} sees no robot of {} and no ball", path, number, options.scenario_file));
  }
  const LearnedColours learned = learn_colours(known, expected);
  if (!report(learned))
    throw std::runtime_error("the pictures do not show what the scenario says: nothing is written");
  write_out(colours_text(learned.thresholds), options.out_file);
  return 0;
}

}  // namespace

int calibrate_command(int argc, char** argv) {
  CLI::App app(
      "Learns colours from pictures of a floor on which everything stands where the scenario begins.", kName);
  CalibrateOptions options;
  app.add_option("SCENARIO", options.scenario_file, "scenario file, see deploy/scenarios/README.md")
      ->required();
  app.add_option("FRAME", options.frame_files, "pictures by cameras, such as PNG files")->required();
  app.add_option("--camera", options.cameras, "which took them: one for all, or N,N,... one for each")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  app.add_option("--cameras", options.cameras_file, "file of cameras [they hang as the scenario says]");
  app.add_option("--layout", options.layout_file, "layout of the robots' markings [the butterfly]");
  app.add_option("--format", options.format, "of the frames to tell colours in [the scenario's]")
      ->check(CLI::IsMember({"yuv422", "rgb"}));
  app.add_option("--out", options.out_file, "file to write the thresholds to [standard output]");
  const int exit_code = parse_options(app, argc, argv);
  if (exit_code >= 0) return exit_code;
  return guarded(kName, [&] { return calibrate(options); });
}

}  // namespace sidestep
