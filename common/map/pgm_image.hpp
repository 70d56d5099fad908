// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>

#include "common/map/map_image.hpp"

namespace sidestep {

/// Reads a PGM image (Netpbm's specification: plain "P2" and raw "P5") from a seekable stream; see
/// read_map_image().
[[nodiscard]] ImageCells read_pgm(std::istream& file, const StateOf& state_of, UnknownCells unknown);

}  // namespace sidestep
