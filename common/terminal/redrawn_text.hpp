// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace sidestep {

/// Text at the end of a terminal's output that is redrawn in place, also after the terminal's size has
/// changed. Use it only if Terminal::can_redraw.
class RedrawnText {
 public:
  explicit RedrawnText(std::FILE* stream) : stream_(stream) {}

  /// Replaces the text by this one, of which fitted() chooses what is drawn.
  void draw(std::string_view text);
  /// Erases the text. Permanent text can then be printed.
  void erase();

 private:
  std::string erasing();

  std::FILE* stream_;
  std::vector<int> columns_;  // of each line that is drawn
};

/// What erases the line of the cursor.
inline constexpr const char* kEraseLine = "\r\x1b[K";

/// What replaces the line of the cursor by this one, cut to the width of the descriptor's terminal.
[[nodiscard]] std::string redrawn_line(std::string_view line, int descriptor);

}  // namespace sidestep
