// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>

namespace sidestep {

/// Throws MapImageError if an image has no pixels or is larger than a map may be.
void check_image_size(long columns, long rows);

/// The number of bytes from the current position of a file to its end.
[[nodiscard]] long bytes_left(std::istream& file);

}  // namespace sidestep
