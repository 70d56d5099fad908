// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// What can be shown where a descriptor leads.
struct Terminal {
  bool can_redraw = false;   ///< the cursor can be moved; false for files, pipes and TERM=dumb
  bool has_colours = false;  ///< can_redraw, and NO_COLOR is unset or empty (https://no-color.org)
};

struct ScreenSize {
  int columns = 80;
  int rows = 24;
};

[[nodiscard]] Terminal terminal_of(int descriptor);

/// The size of a terminal now. 80 columns and 24 rows if the terminal does not know it, or if it is none.
[[nodiscard]] ScreenSize screen_size(int descriptor);

}  // namespace sidestep
