// SPDX-License-Identifier: Apache-2.0
#include "vision/images/image_options.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <stdexcept>

#include "vision/cameras/camera_file.hpp"
#include "common/camera/camera_grid.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "vision/colours/default_colours.hpp"

namespace sidestep {
namespace {

std::vector<CameraModel> cameras_from(const std::string& file, const Scenario& scenario) {
  std::vector<CameraModel> cameras;
  const std::vector<NumberedCamera> listed = load_cameras(file);
  for (const NumberedCamera& camera : listed) {
    if (camera.id != cameras.size()) {
      throw std::invalid_argument(fmt::format("{}: camera {} stands where {} is expected: they count from 0",
                                              file, camera.id, cameras.size()));
    }
    cameras.emplace_back(camera.parameters);
  }
  const int count = scenario.vision.columns * scenario.vision.rows;
  if (static_cast<int>(cameras.size()) != count) {
    throw std::invalid_argument(fmt::format("{}: {} cameras, {} expected", file, cameras.size(), count));
  }
  return cameras;
}

}  // namespace

void add_image_options(CLI::App& app, ImageOptions& options) {
  app.add_option("--colours", options.colours_file,
                 "thresholds of the colours in images, see sidestep-vision calibrate [those of good light]");
  app.add_option("--cameras", options.cameras_file, "how the cameras hang [as the scenario says]");
  app.add_option("--layout", options.layout_file, "layout of the robots' markings [the butterfly]");
}

ImageReader image_reader(const Scenario& scenario, const ImageOptions& options) {
  const PixelFormat format = scenario.vision.images.value_or(ImageSpec()).format;
  const MarkingLayout layout = options.layout_file.empty() ? butterfly() : load_layout(options.layout_file);
  const ColourThresholds colours =
      options.colours_file.empty() ? default_colours(format, layout) : load_colours(options.colours_file);
  if (colours.format != format) {
    throw std::invalid_argument(fmt::format("{}: is for {}, and the scenario's images are {}",
                                            options.colours_file, name_of(colours.format), name_of(format)));
  }
  return ImageReader(
      scenario,
      options.cameras_file.empty() ? hang_grid(scenario) : cameras_from(options.cameras_file, scenario),
      colours, layout);
}

}  // namespace sidestep
