// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "common/image/image_error.hpp"
#include "common/map/bit_grid.hpp"

namespace sidestep {

enum class MapCellState : std::uint8_t { kFree, kOccupied, kUnknown };

/// Maps a pixel's brightness, from 0 (black) to 1 (white), to the state of its cell.
using StateOf = std::function<MapCellState(double brightness)>;

/// The treatment of cells of unknown occupancy.
enum class UnknownCells : std::uint8_t { kBlocked, kFree };

/// A grid whose bits are 1 where a cell is blocked.
struct ImageCells {
  BitGrid blocked;
  std::size_t unknown = 0;  ///< number of unknown cells
};

/// Reads an image; its last row becomes row 0. Formats, recognised by their content: PGM (P2, P5; up to 16
/// bits) and PNG (any kind; colours are averaged, and a pixel that is not opaque is unknown). Throws
/// ImageError if the file cannot be read, has neither format, is larger than a map may be, is truncated or
/// damaged, or has a gamma other than sRGB's. As far as possible, this is checked before memory for the image
/// is allocated.
[[nodiscard]] ImageCells read_map_image(const std::string& path, const StateOf& state_of,
                                        UnknownCells unknown);

}  // namespace sidestep
