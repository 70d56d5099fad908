// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_image.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <string_view>

#include "common/map/pgm_image.hpp"
#include "common/map/png_image.hpp"

namespace sidestep {

ImageCells read_map_image(const std::string& path, const StateOf& state_of, UnknownCells unknown_cells) {
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown))
    throw ImageError("it is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw ImageError(fmt::format("cannot read it ({})", std::strerror(errno)));
  char magic[2] = {};
  file.read(magic, sizeof(magic));
  const std::string_view begin(magic, sizeof(magic));
  file.clear();
  file.seekg(0);
  if (begin == "P2" || begin == "P5") return read_pgm(file, state_of, unknown_cells);
  if (begin == "\x89P") return read_png(file, state_of, unknown_cells);
  throw ImageError("it is neither a PGM image (P2 or P5) nor a PNG image");
}

}  // namespace sidestep
