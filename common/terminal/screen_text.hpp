// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/terminal/terminal.hpp"

namespace sidestep {

enum class TextColour { kNone, kRed, kGreen, kYellow, kBold };

/// The text between the escape sequences that set and reset the colour.
[[nodiscard]] std::string coloured(std::string_view text, TextColour colour);

/// The number of columns of a line. Colours take none, each character takes one.
[[nodiscard]] int columns_of(std::string_view line);

/// The beginning of a line that takes at most this many columns, with all colours of the line.
[[nodiscard]] std::string cut_to(std::string_view line, int columns);

/// Distributes the parts over lines of at most this many columns, if each part fits. Parts in one line are
/// separated by two spaces; each line ends with a line break.
[[nodiscard]] std::string wrapped(const std::vector<std::string>& parts, int columns);

/// As many of the text's lines as fit on the screen above the line of the cursor, cut to the screen's width.
/// If lines are left out, the last one says how many.
[[nodiscard]] std::string fitted(std::string_view text, const ScreenSize& screen);

}  // namespace sidestep
