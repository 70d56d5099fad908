// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>

#include "common/map/map_image.hpp"

namespace sidestep {

/// Reads a PNG image from a seekable stream; see read_map_image(). Samples are used as stored, so an image
/// whose gamma would change them is rejected.
[[nodiscard]] ImageCells read_png(std::istream& file, const StateOf& state_of, UnknownCells unknown);

}  // namespace sidestep
