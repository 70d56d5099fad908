// SPDX-License-Identifier: Apache-2.0
#include "vision/images/image_options.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "common/camera/camera_grid.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "vision/cameras/camera_file.hpp"
#include "vision/colours/default_colours.hpp"

namespace sidestep {
namespace {

std::vector<CameraModel> cameras_from(const std::string& file, const Scenario& scenario) {
  std::vector<CameraModel> cameras;
  const std::vector<NumberedCamera> listed = load_cameras(file);
  for (const NumberedCamera& camera : listed) {
    if (camera.id != cameras.size()) {
      throw std::invalid_argument(fmt::format("{}: cameras[{}].id: expected {}, got {}", file, cameras.size(),
                                              cameras.size(), camera.id));
    }
    cameras.emplace_back(camera.parameters);
  }
  const int count = scenario.vision.columns * scenario.vision.rows;
  if (static_cast<int>(cameras.size()) != count) {
    throw std::invalid_argument(
        fmt::format("{}: expected {} cameras for the scenario, got {}", file, count, cameras.size()));
  }
  return cameras;
}

}  // namespace

ImageReader image_reader(const Scenario& scenario, const ImageOptions& options) {
  const PixelFormat format = scenario.vision.images.value_or(ImageSpec()).format;
  const MarkerLayout layout = options.layout_file.empty() ? butterfly() : load_layout(options.layout_file);
  const ColourThresholds colours =
      options.colours_file.empty() ? default_colours(format, layout) : load_colours(options.colours_file);
  if (colours.format != format) {
    throw std::invalid_argument(fmt::format("{}: format: expected {} for the scenario's images, got {}",
                                            options.colours_file, name_of(format), name_of(colours.format)));
  }
  return ImageReader(
      scenario,
      options.cameras_file.empty() ? camera_grid(scenario) : cameras_from(options.cameras_file, scenario),
      colours, layout);
}

}  // namespace sidestep
