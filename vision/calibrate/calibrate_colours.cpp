// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/calibrate_colours.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/image/picture.hpp"
#include "common/image/pixel_conversion.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "vision/cameras/camera_file.hpp"

namespace sidestep {
namespace {

/// The camera of a picture: from the cameras file, or from the scenario's camera grid with the picture's
/// size.
CameraModel camera_of(const CalibrateColoursOptions& options, std::uint32_t number, const Scenario& scenario,
                      const ImageView& picture, const std::string& picture_file) {
  if (options.cameras_file.empty()) {
    ImageSpec images = scenario.vision.images.value_or(ImageSpec());
    images.width_px = picture.width_px;
    images.height_px = picture.height_px;
    const std::vector<CameraModel> cameras =
        camera_grid(scenario.field, scenario.vision, overhead_camera_of(images));
    if (number < cameras.size()) return cameras[number];
    throw std::invalid_argument(fmt::format("--camera: expected 0 to {}, the cameras of {}, got {}",
                                            cameras.size() - 1, options.scenario_file, number));
  }
  const std::vector<NumberedCamera> cameras = load_cameras(options.cameras_file);
  const auto camera = std::ranges::find(cameras, number, &NumberedCamera::id);
  if (camera == cameras.end())
    throw std::invalid_argument(
        fmt::format("--camera {}: {} has no camera with this id", number, options.cameras_file));
  const CameraParameters& p = camera->parameters;
  if (p.width_px != picture.width_px || p.height_px != picture.height_px)
    throw std::invalid_argument(fmt::format(
        "{}: expected {} x {} pixels, the size of camera {} in {}, got {} x {}", picture_file, p.width_px,
        p.height_px, number, options.cameras_file, picture.width_px, picture.height_px));
  return CameraModel(p);
}

PixelFormat format_of(const CalibrateColoursOptions& options, const Scenario& scenario) {
  if (!options.format.empty()) return *pixel_format_named(options.format);
  return scenario.vision.images.value_or(ImageSpec()).format;
}

Image read_frame(const std::string& path, PixelFormat format) {
  const Image picture = read_picture(path);
  if (format == PixelFormat::kYuv422 && picture.view().width_px % 2 != 0)
    throw std::invalid_argument(
        fmt::format("{}: expected an even width for yuv422, got {} pixels", path, picture.view().width_px));
  return converted_to(format, picture.view());
}

}  // namespace

LearnedColours calibrate_colours(const CalibrateColoursOptions& options) {
  const std::size_t count = options.frame_files.size();
  if (options.cameras.size() != 1 && options.cameras.size() != count)
    throw std::invalid_argument(
        fmt::format("--camera: expected 1 number, or one for each of the {} frames, got {}", count,
                    options.cameras.size()));
  const Scenario scenario = load_scenario(options.scenario_file);
  const MarkerLayout layout = options.layout_file.empty() ? butterfly() : load_layout(options.layout_file);
  const std::vector<Colour> expected = colours_at_start(scenario, layout);
  std::vector<Image> images;
  std::vector<LabelledImage> labelled;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& path = options.frame_files[i];
    const std::uint32_t number = options.cameras[options.cameras.size() > 1 ? i : 0];
    images.push_back(read_frame(path, format_of(options, scenario)));
    const ImageView view = images.back().view();
    labelled.push_back(
        {view, floor_labels_at_start(scenario, layout, camera_of(options, number, scenario, view, path))});
    if (labelled.back().labels.discs.empty())
      throw std::invalid_argument(fmt::format("{}: camera {} has no robot of {} and no ball in view", path,
                                              number, options.scenario_file));
  }
  return learn_colours(labelled, expected);
}

bool is_plausible(const LearnedColours& learned) {
  constexpr double kMinRecall = 0.5;
  return std::ranges::all_of(
      learned.colours, [](const LearnedColour& one) { return one.pixels == 0 || one.recall > kMinRecall; });
}

}  // namespace sidestep
