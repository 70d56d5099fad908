// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include "common/map/bit_grid.hpp"

namespace sidestep {

/// Why an image cannot be used; what() does not name the file.
class MapImageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Whether a pixel of this brightness, 0 (black) to 1 (white), is certainly free.
using IsFree = std::function<bool(double brightness)>;

/// Reads an image as a grid whose bits are 1 where a cell is blocked; the image's last row becomes row 0.
/// Formats, recognised by their content: PGM (P2, P5; up to 16 bits) and PNG (any kind; colours are averaged,
/// and a pixel that is not opaque is blocked). Throws MapImageError if the file cannot be read, is neither,
/// is larger than a map may be, is truncated or damaged, or has a gamma other than sRGB's; before memory for
/// the image is allocated as far as possible.
[[nodiscard]] BitGrid read_map_image(const std::string& path, const IsFree& is_free);

}  // namespace sidestep
