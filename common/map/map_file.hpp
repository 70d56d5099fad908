// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/map/map_image.hpp"
#include "common/map/occupancy_map.hpp"

namespace sidestep {

/// A map loaded from its file, with properties of the file that the user must know.
struct LoadedMap {
  OccupancyMap cells;
  std::size_t unknown = 0;  ///< number of cells that are neither known to be free nor known to be occupied
  double yaw_rad = 0;       ///< rotation of the map's rows and columns in other programs' frame
};

/// Reads a map in the format of ROS's map_server: a YAML file with the keys image, resolution, origin,
/// negate, occupied_thresh, free_thresh and optionally mode (trinary, scale, raw), and a PGM or PNG image,
/// whose path is relative to the YAML file. A cell is free only if its probability of occupancy is below
/// free_thresh. In mode trinary, pixels with the grey that map savers write for unknown cells are unknown,
/// regardless of free_thresh. In mode raw, the samples are the probability in per cent, and those above 100
/// are unknown. The axes follow the map's rows and columns, even if its origin has a yaw. Throws ConfigError;
/// errors in the image name the image file.
[[nodiscard]] LoadedMap load_map(const std::string& path, UnknownCells unknown = UnknownCells::kBlocked);

/// The contents of the two files of a map.
struct MapFiles {
  std::string yaml;
  std::string image;  ///< content of the PGM file
};

/// File contents that load_map() would read back as this map, if the image is stored as `image_name`.
[[nodiscard]] MapFiles map_files(const OccupancyMap& map, const std::string& image_name);

/// Writes a map as `path`.pgm and `path`.yaml. Throws std::runtime_error if a file cannot be written.
void write_occupancy_map(const OccupancyMap& map, const std::string& path);

}  // namespace sidestep
