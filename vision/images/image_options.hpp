// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "vision/images/image_reader.hpp"

namespace CLI {
class App;
}

namespace sidestep {

/// What is known of cameras and markings beyond the scenario.
struct ImageOptions {
  std::string colours_file{};  ///< empty: default_colours()
  std::string cameras_file{};  ///< empty: they hang as the scenario says
  std::string layout_file{};   ///< empty: the butterfly
};

/// Adds --colours, --cameras and --layout.
void add_image_options(CLI::App& app, ImageOptions& options);

/// What reads a scenario's images. Throws ScenarioError for a file, and std::invalid_argument for one that
/// does not fit the scenario.
ImageReader image_reader(const Scenario& scenario, const ImageOptions& options);

}  // namespace sidestep
