// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace sidestep {

struct PictureSize {
  std::uint64_t width_px = 0, height_px = 0;
};

/// The size that the header of a picture in PNG, JPEG or PNM (P1 to P6) states, before anything is decoded.
/// nullopt: the bytes are nothing of that, or the header is malformed. Untrusted.
[[nodiscard]] std::optional<PictureSize> stated_size(std::string_view picture);

}  // namespace sidestep
