// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/map/occupancy_map.hpp"

namespace sidestep {

/// Reads a map in the format of ROS's map_server: a YAML file with the keys image, resolution, origin,
/// negate, occupied_thresh, free_thresh and optionally mode (trinary, scale, raw), and a PGM or PNG image,
/// whose path is relative to the YAML file. A cell is free only if its probability of occupancy is below
/// free_thresh; **unknown cells are blocked**. In mode raw, the samples are the probability in per cent, and
/// those above 100 are unknown. Throws ConfigError; errors of the image name it. The map must not be rotated
/// (yaw 0).
[[nodiscard]] OccupancyMap load_occupancy_map(const std::string& path);

/// The contents of the two files of a map.
struct MapFiles {
  std::string yaml;
  std::string image;  ///< PGM
};

/// What load_occupancy_map reads as this map, if the image is stored as `image_name`.
[[nodiscard]] MapFiles map_files(const OccupancyMap& map, const std::string& image_name);

/// Writes them as `path`.pgm and `path`.yaml. Throws std::runtime_error if a file cannot be written.
void write_occupancy_map(const OccupancyMap& map, const std::string& path);

}  // namespace sidestep
