// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

#include "common/map/bit_grid.hpp"

namespace sidestep {

/// Why an image cannot be used; what() does not name the file.
class MapImageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class CellState : std::uint8_t { kFree, kOccupied, kUnknown };

/// What a pixel of this brightness, 0 (black) to 1 (white), says of its cell.
using StateOf = std::function<CellState(double brightness)>;

/// What becomes of cells of which nobody knows whether they are free.
enum class UnknownCells : std::uint8_t { kBlocked, kFree };

/// A grid whose bits are 1 where a cell is blocked.
struct ImageCells {
  BitGrid blocked;
  std::size_t unknown = 0;  ///< how many are unknown
};

/// Reads an image; its last row becomes row 0. Formats, recognised by their content: PGM (P2, P5; up to 16
/// bits) and PNG (any kind; colours are averaged, and a pixel that is not opaque is unknown). Throws
/// MapImageError if the file cannot be read, is neither, is larger than a map may be, is truncated or
/// damaged, or has a gamma other than sRGB's; before memory for the image is allocated as far as possible.
[[nodiscard]] ImageCells read_map_image(const std::string& path, const StateOf& state_of,
                                        UnknownCells unknown);

}  // namespace sidestep
