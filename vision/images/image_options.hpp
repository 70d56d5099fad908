// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "vision/images/image_reader.hpp"

namespace sidestep {

/// Files that describe cameras, colours and markers in addition to the scenario.
struct ImageOptions {
  std::string colours_file{};  ///< empty: default_colours()
  std::string cameras_file{};  ///< empty: the scenario's cameras
  std::string layout_file{};   ///< empty: the butterfly layout
};

/// Creates the reader for a scenario's images. Throws ConfigError for an invalid file, and
/// std::invalid_argument for a file that does not fit the scenario.
[[nodiscard]] ImageReader image_reader(const Scenario& scenario, const ImageOptions& options);

}  // namespace sidestep
