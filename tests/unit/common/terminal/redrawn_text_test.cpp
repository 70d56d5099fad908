// SPDX-License-Identifier: Apache-2.0
#include "common/terminal/redrawn_text.hpp"

#include <fmt/format.h>

#include "common/file/console.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/pseudo_terminal.hpp"
#include "tests/screen.hpp"

namespace sidestep::redrawn_text_test {

/// A terminal, and what it shows.
struct Shown {
  Shown(int columns, int rows) : terminal(columns, rows), screen(columns, rows) {}
  void resize(int columns, int rows) {
    update();
    terminal.resize(columns, rows);
    screen.resize(columns, rows);
  }
  const Screen& update() {
    screen.feed(terminal.read_all());
    return screen;
  }
  PseudoTerminal terminal;
  Screen screen;
};

TEST_CASE("a text is redrawn in place, below permanent lines") {
  Shown shown(20, 10);
  RedrawnText text(shown.terminal.stream());
  text.draw("time 1\nrobot 1 drives\n");
  text.draw("time 2\nrobot 1 drives\nrobot 2 drives\n");
  text.erase();
  print_to(shown.terminal.stream(), "robot 1 arrived\n");
  text.draw("time 3\n");
  CHECK(shown.update().text() == "robot 1 arrived\ntime 3\n");
  text.erase();
  text.erase();
  CHECK(shown.update().text() == "robot 1 arrived\n");
  CHECK(shown.screen.unknown().empty());
}

TEST_CASE("a text of any size is redrawn without smearing, on screens of any size, also when it changes") {
  const std::uint64_t seed = GENERATE(range(1, 40));
  CAPTURE(seed);
  Rng rng(seed);
  // In the narrowest terminal, the text of the widest one still fits on the screen.
  const auto columns = [&] { return 20 + static_cast<int>(rng.below(60)); };
  Shown shown(columns(), 60);
  RedrawnText text(shown.terminal.stream());
  int permanent = 0;
  std::string last;
  for (int step = 0; step < 30; ++step) {
    if (rng.chance(0.2)) shown.resize(columns(), 60);
    if (rng.chance(0.3)) {
      text.erase();
      print_to(shown.terminal.stream(), "P\n");
      ++permanent;
    }
    last.clear();
    for (std::size_t i = rng.below(12); i > 0; --i) last += std::string(1 + rng.below(100), 'x') + "\n";
    text.draw(last);
    const Screen& screen = shown.update();
    INFO(screen.text());
    REQUIRE(screen.wraps() == 0);
    REQUIRE(screen.count("P") == permanent);
    REQUIRE(std::ranges::ssize(screen.lines()) == permanent + std::ranges::count(last, '\n'));
  }
}

TEST_CASE("a text with more lines than the screen leaves no line behind") {
  Shown shown(30, 5);
  RedrawnText text(shown.terminal.stream());
  for (int time = 0; time < 4; ++time) text.draw(fmt::format("time {}\n1\n2\n3\n4\n5\n", time));
  CHECK(shown.update().text() == "time 3\n1\n2\n... and 3 more lines\n");
}

TEST_CASE("a progress line replaces the line of the cursor, cut to the terminal's width") {
  Shown shown(10, 5);
  for (const char* line : {"a longer line", "another line", "end"})
    print_to(shown.terminal.stream(), "{}", redrawn_line(line, shown.terminal.slave()));
  CHECK(shown.update().text() == "end\n");
  CHECK(shown.screen.wraps() == 0);
  print_to(shown.terminal.stream(), "{}", redrawn_line("0123456789abc", shown.terminal.slave()));
  CHECK(shown.update().text() == "012345678\n");
}

}  // namespace sidestep::redrawn_text_test
