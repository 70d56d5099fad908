// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sidestep {

/// Contrast of text and background according to WCAG 2.1, from 1 to 21. The colours are given as "#rrggbb".
[[nodiscard]] double contrast(std::string_view first, std::string_view second);

/// A colour that differs from those of the preceding indices and on which white text is legible, as
/// "#rrggbb".
[[nodiscard]] std::string distinct_colour(std::size_t index);

}  // namespace sidestep
