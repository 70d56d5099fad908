// SPDX-License-Identifier: Apache-2.0
#include "vision/images/image_arguments.hpp"

namespace sidestep {

void add_image_options(const CliCommand& command, ImageOptions& options) {
  command.add_option(
      "--colours", options.colours_file,
      "thresholds of the colours in images, see sidestep-vision calibrate [default thresholds]");
  command.add_option("--cameras", options.cameras_file, "file of cameras [cameras as in the scenario]");
  command.add_option("--layout", options.layout_file, "layout of the robots' markers [the butterfly]");
}

}  // namespace sidestep
