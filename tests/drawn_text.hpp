// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/terminal/redrawn_text.hpp"
#include "tests/pseudo_terminal.hpp"
#include "tests/screen.hpp"

namespace sidestep {

/// What a terminal of this many columns shows of a text that is drawn twice, as a table is when it changes.
inline Screen screen_of(const std::string& text, int columns) {
  constexpr int kRows = 24;
  const PseudoTerminal terminal(columns, kRows);
  RedrawnText drawn(terminal.stream());
  drawn.draw(text);
  drawn.draw(text);
  Screen screen(columns, kRows);
  screen.feed(terminal.read_all());
  return screen;
}

}  // namespace sidestep
