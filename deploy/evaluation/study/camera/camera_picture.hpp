// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace sidestep {

/// Draws the first frame of a drive with the blocked cells, the diamonds, and the paths on cells (orange) and
/// around the diamonds (blue) as a PNG file. Throws std::runtime_error if it cannot be written.
void write_camera_picture(std::uint64_t seed, const std::string& path);

}  // namespace sidestep
