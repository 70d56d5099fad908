// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sidestep {

/// What a terminal of this size shows after it has received some bytes. Knows what Sidestep sends:
/// characters, of which those of several bytes are shown as "?", line breaks, cursor up, erasing, colours.
/// Like common terminals, it wraps a line only before the next character, and wraps the lines anew when it
/// becomes narrower.
class Screen {
 public:
  Screen(int columns, int rows) : columns_(columns), rows_(rows) {}

  void feed(std::string_view bytes) {
    for (const char byte : bytes) {
      if (!sequence_.empty() || byte == '\x1b')
        add_to_sequence(byte);
      else if (byte == '\n')
        ++row_;
      else if (byte == '\r')
        column_ = 0;
      else if (is_first(byte))
        put(is_single(byte) ? byte : '?');
    }
  }
  void resize(int columns, int rows) {
    std::vector<std::string> lines;
    std::size_t row = row_;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      std::string rest = lines_[i];
      for (; rest.size() > static_cast<std::size_t>(columns);
           rest.erase(0, static_cast<std::size_t>(columns))) {
        lines.push_back(rest.substr(0, static_cast<std::size_t>(columns)));
        row += i < row_;
      }
      lines.push_back(rest);
    }
    lines_ = lines;
    row_ = row;
    columns_ = columns;
    rows_ = rows;
  }

  /// The lines that were printed, also those that have left the screen at its top, without trailing blanks.
  std::vector<std::string> lines() const {
    std::vector<std::string> result = lines_;
    for (std::string& line : result) line.erase(line.find_last_not_of(' ') + 1);
    while (!result.empty() && result.back().empty()) result.pop_back();
    return result;
  }
  std::string text() const {
    std::string result;
    for (const std::string& line : lines()) result += line + "\n";
    return result;
  }
  /// How many lines contain the text.
  std::ptrdiff_t count(const std::string& text) const {
    return std::ranges::count_if(lines_,
                                 [&](const std::string& line) { return line.find(text) != line.npos; });
  }
  /// How often a character did not fit into its line.
  int wraps() const { return wraps_; }
  int colours() const { return colours_; }
  /// Sequences that it does not know.
  const std::string& unknown() const { return unknown_; }

 private:
  /// Whether the byte is a character of UTF-8.
  static bool is_single(char byte) { return (static_cast<unsigned char>(byte) & 0x80) == 0; }
  /// Whether the byte begins a character of UTF-8.
  static bool is_first(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }
  std::string& line() {
    if (lines_.size() <= row_) lines_.resize(row_ + 1);
    return lines_[row_];
  }
  void put(char byte) {
    if (column_ == static_cast<std::size_t>(columns_)) {
      ++wraps_;
      ++row_;
      column_ = 0;
    }
    std::string& text = line();
    if (text.size() <= column_) text.resize(column_ + 1, ' ');
    text[column_++] = byte;
  }
  void add_to_sequence(char byte) {
    sequence_ += byte;
    const bool is_end = sequence_.size() > 2 && byte >= '@';
    if (!is_end) return;
    std::size_t number = 1;
    std::from_chars(sequence_.data() + 2, sequence_.data() + sequence_.size(), number);
    if (byte == 'A')
      // The cursor does not leave the screen.
      row_ -= std::min({number, row_, row_ - top()});
    else if (byte == 'J')
      erase_below();
    else if (byte == 'K')
      line().resize(std::min(column_, line().size()));
    else if (byte == 'm')
      ++colours_;
    else
      unknown_ += sequence_.substr(1) + " ";
    sequence_.clear();
  }
  void erase_below() {
    line().resize(std::min(column_, line().size()));
    lines_.resize(row_ + 1);
  }
  /// The first line that is on the screen.
  std::size_t top() const {
    const std::size_t used = std::max(lines_.size(), row_ + 1);
    return used - std::min(used, static_cast<std::size_t>(rows_));
  }

  int columns_, rows_, wraps_ = 0, colours_ = 0;
  std::size_t row_ = 0, column_ = 0;
  std::vector<std::string> lines_;
  std::string sequence_, unknown_;
};

}  // namespace sidestep
