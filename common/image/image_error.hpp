// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stdexcept>

namespace sidestep {

/// Why an image cannot be used; what() does not name the file.
class ImageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws ImageError if an image of this size is not accepted. Decoders call it with the size stated in the
/// header, before they allocate memory for pixels.
using ImageSizeCheck = std::function<void(long width_px, long height_px)>;

}  // namespace sidestep
