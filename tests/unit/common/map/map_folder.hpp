// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <unistd.h>

#include "common/file/write_file.hpp"
#include "common/map/map_file.hpp"
#include "common/yaml/config_error.hpp"

namespace sidestep::test {

/// A temporary folder for the files of a map.
class MapFolder {
 public:
  MapFolder() { std::filesystem::create_directories(path_); }
  ~MapFolder() { std::filesystem::remove_all(path_); }
  MapFolder(const MapFolder&) = delete;
  MapFolder& operator=(const MapFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  /// The map given by a YAML text and, unless empty, an image "map.pgm".
  OccupancyMap load(const std::string& yaml, const std::string& image) const {
    return load_all(yaml, image).cells;
  }
  LoadedMap load_all(const std::string& yaml, const std::string& image,
                     UnknownCells unknown = UnknownCells::kBlocked) const {
    if (!image.empty()) write_file(*this / "map.pgm", image);
    write_file(*this / "map.yaml", yaml);
    return load_map(*this / "map.yaml", unknown);
  }

  /// The message of the ConfigError that load() throws, from the file's name on, or "accepted".
  std::string error(const std::string& yaml, const std::string& image) const {
    try {
      (void)load(yaml, image);
    } catch (const ConfigError& error) {
      return std::string(error.what()).substr(path_.string().size() + 1);
    }
    return "accepted";
  }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("sidestep-map-test-" + std::to_string(getpid()));
};

/// A map with 0.1 m cells in "map.pgm" and the thresholds 0.65 and 0.196; the key `image` is on line 1.
inline const std::string kMapYaml =
    "image: map.pgm\nresolution: 0.1\norigin: [-1.5, 2.25, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
    "free_thresh: 0.196\n";

/// Returns the text with the first occurrence of `old_part` replaced.
inline std::string replaced(std::string text, const std::string& old_part, const std::string& new_part) {
  return text.replace(text.find(old_part), old_part.size(), new_part);
}

/// Draws the map with '#' for blocked and '.' for free cells; top row first, with '/' after each row.
inline std::string drawing(const OccupancyMap& map) {
  std::string rows;
  for (int row = map.grid().rows - 1; row >= 0; --row, rows += '/')
    for (int column = 0; column < map.grid().columns; ++column)
      rows += map.is_blocked({column, row}) ? '#' : '.';
  return rows;
}

}  // namespace sidestep::test
