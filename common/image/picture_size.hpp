// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace sidestep {

struct PictureSize {
  std::uint64_t width_px = 0, height_px = 0;
};

/// The size stated in the header of a PNG, JPEG or PNM (P1 to P6) picture, read without decoding it. nullopt
/// if the bytes are in none of these formats or the header is malformed. The bytes are untrusted.
[[nodiscard]] std::optional<PictureSize> stated_size(std::string_view picture);

}  // namespace sidestep
