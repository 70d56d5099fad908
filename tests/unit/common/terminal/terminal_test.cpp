// SPDX-License-Identifier: Apache-2.0
#include "common/terminal/terminal.hpp"

#include "tests/catch.hpp"
#include "tests/pseudo_terminal.hpp"

namespace sidestep::terminal_test {

TEST_CASE("a terminal is redrawn and coloured unless TERM or NO_COLOR says otherwise") {
  struct Case {
    const char *term, *no_color;
    bool can_redraw, has_colours;
  };
  const auto [term, no_color, can_redraw, has_colours] = GENERATE(
      Case{"xterm-256color", nullptr, true, true}, Case{"tmux-256color", "", true, true},
      Case{"xterm", "1", true, false}, Case{"xterm", "0", true, false}, Case{"dumb", nullptr, false, false},
      Case{nullptr, nullptr, false, false}, Case{"", nullptr, false, false});
  const EnvironmentVariable type("TERM", term), wish("NO_COLOR", no_color);
  const PseudoTerminal pseudo(80, 24);
  CAPTURE(term ? term : "unset", no_color ? no_color : "unset");
  const Terminal terminal = terminal_of(pseudo.slave());
  CHECK(terminal.can_redraw == can_redraw);
  CHECK(terminal.has_colours == has_colours);
}

TEST_CASE("files and pipes are neither redrawn nor coloured") {
  const EnvironmentVariable type("TERM", "xterm");
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const int file = open("/dev/null", O_WRONLY);
  for (const int descriptor : {ends[1], file, -1}) {
    CHECK_FALSE(terminal_of(descriptor).can_redraw);
    CHECK_FALSE(terminal_of(descriptor).has_colours);
    CHECK(screen_size(descriptor).columns == 80);
    CHECK(screen_size(descriptor).rows == 24);
  }
  for (const int descriptor : {ends[0], ends[1], file}) close(descriptor);
}

TEST_CASE("the size of a terminal is its present one, or 80 by 24 if it is unknown") {
  const PseudoTerminal pseudo(60, 10);
  CHECK(screen_size(pseudo.slave()).columns == 60);
  CHECK(screen_size(pseudo.slave()).rows == 10);
  pseudo.resize(120, 50);
  CHECK(screen_size(pseudo.slave()).columns == 120);
  CHECK(screen_size(pseudo.slave()).rows == 50);
  pseudo.resize(0, 0);
  CHECK(screen_size(pseudo.slave()).columns == 80);
  CHECK(screen_size(pseudo.slave()).rows == 24);
}

}  // namespace sidestep::terminal_test
