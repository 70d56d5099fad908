// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace sidestep {

/// Draws the first frame of a drive as a PNG file, with the blocked cells, the diamonds, the path on cells
/// (orange) and the path around the diamonds (blue). Throws std::runtime_error if the file cannot be written.
void write_camera_picture(std::uint64_t seed, const std::string& path);

}  // namespace sidestep
