// SPDX-License-Identifier: Apache-2.0
#include "common/terminal/redrawn_text.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/file/console.hpp"
#include "common/terminal/screen_text.hpp"
#include "common/terminal/terminal.hpp"

namespace sidestep {

std::string RedrawnText::erasing() {
  if (columns_.empty()) return "";
  // In a terminal that has become narrower, each line may take several rows.
  const int width = std::max(screen_size(fileno(stream_)).columns, 1);
  int rows = 0;
  for (const int columns : columns_) rows += std::max((columns + width - 1) / width, 1);
  columns_.clear();
  return fmt::format("\r\x1b[{}A\x1b[J", rows);
}

void RedrawnText::draw(std::string_view text) {
  const std::string drawn = fitted(text, screen_size(fileno(stream_)));
  // One write, so that the text does not flicker.
  const std::string all = erasing() + drawn;
  for (std::size_t at = 0; at < drawn.size();) {
    const std::size_t end = drawn.find('\n', at);
    columns_.push_back(columns_of(std::string_view(drawn).substr(at, end - at)));
    at = end + 1;
  }
  (void)write_text(stream_, all);
}

void RedrawnText::erase() { (void)write_text(stream_, erasing()); }

std::string redrawn_line(std::string_view line, int descriptor) {
  return kEraseLine + cut_to(line, screen_size(descriptor).columns - 1);
}

}  // namespace sidestep
