// SPDX-License-Identifier: Apache-2.0
#include "common/terminal/terminal.hpp"

#include <cstdlib>
#include <string>
#include <sys/ioctl.h>
#include <unistd.h>

namespace sidestep {
namespace {

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

Terminal terminal_of(int descriptor) {
  const std::string type = variable("TERM");
  Terminal terminal;
  terminal.can_redraw = isatty(descriptor) == 1 && !type.empty() && type != "dumb";
  terminal.has_colours = terminal.can_redraw && variable("NO_COLOR").empty();
  return terminal;
}

ScreenSize screen_size(int descriptor) {
  ScreenSize size;
  winsize known{};
  if (ioctl(descriptor, TIOCGWINSZ, &known) != 0) return size;
  if (known.ws_col > 0) size.columns = known.ws_col;
  if (known.ws_row > 0) size.rows = known.ws_row;
  return size;
}

}  // namespace sidestep
