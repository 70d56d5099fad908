// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vision/calibrate/learn_colours.hpp"

namespace sidestep {

struct CalibrateColoursOptions {
  std::string scenario_file;
  std::vector<std::string> frame_files;
  std::vector<std::uint32_t> cameras{0};  ///< camera numbers: one for all frames, or one for each frame
  std::string cameras_file{};             ///< empty: the scenario's cameras
  std::string layout_file{};              ///< empty: the butterfly layout
  std::string format{};                   ///< empty: the scenario's format
};

/// Learns colours from pictures of a scenario's floor at the start. Throws ConfigError for an invalid file,
/// and std::invalid_argument for options or pictures that do not fit the scenario.
[[nodiscard]] LearnedColours calibrate_colours(const CalibrateColoursOptions& options);

/// Whether the thresholds recognise most pixels of every colour. If not, the pictures do not match the
/// scenario.
[[nodiscard]] bool is_plausible(const LearnedColours& learned);

}  // namespace sidestep
