// SPDX-License-Identifier: Apache-2.0
#include "common/terminal/screen_text.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/file/utf8.hpp"

namespace sidestep {
namespace {

constexpr char kEscape = '\x1b';

const char* code_of(TextColour colour) {
  switch (colour) {
    case TextColour::kRed:
      return "31";
    case TextColour::kGreen:
      return "32";
    case TextColour::kYellow:
      return "33";
    case TextColour::kBold:
      return "1";
    case TextColour::kNone:
      break;
  }
  return "";
}

/// The bytes of the character or colour at a position. A byte that is not UTF-8 counts as one character.
std::string_view piece_at(std::string_view line, std::size_t at) {
  if (line[at] == kEscape) {
    const std::size_t end = line.find('m', at);
    return line.substr(at, end == std::string_view::npos ? end : end + 1 - at);
  }
  return line.substr(at, std::max<std::size_t>(utf8_length(line, at), 1));
}

}  // namespace

std::string coloured(std::string_view text, TextColour colour) {
  return colour == TextColour::kNone ? std::string(text)
                                     : fmt::format("\x1b[{}m{}\x1b[0m", code_of(colour), text);
}

int columns_of(std::string_view line) {
  int columns = 0;
  for (std::size_t at = 0; at < line.size();) {
    const std::string_view piece = piece_at(line, at);
    columns += piece.front() != kEscape;
    at += piece.size();
  }
  return columns;
}

std::string cut_to(std::string_view line, int columns) {
  std::string result;
  int used = 0;
  for (std::size_t at = 0; at < line.size();) {
    const std::string_view piece = piece_at(line, at);
    at += piece.size();
    if (piece.front() == kEscape)
      result += piece;
    else if (used++ < columns)
      result += piece;
  }
  return result;
}

std::string wrapped(const std::vector<std::string>& parts, int columns) {
  std::string text, line;
  for (const std::string& part : parts) {
    if (!line.empty() && columns_of(line) + 2 + columns_of(part) > columns) {
      text += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : "  ") + part;
  }
  return text + line + "\n";
}

std::string fitted(std::string_view text, const ScreenSize& screen) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    // A character in the last column would make some terminals begin a new line.
    lines.push_back(cut_to(text.substr(0, end), screen.columns - 1));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  const auto room = static_cast<std::size_t>(std::max(screen.rows - 1, 1));
  if (lines.size() > room) {
    const std::size_t left_out = lines.size() - (room - 1);
    lines.resize(room - 1);
    lines.push_back(cut_to(fmt::format("... and {} more lines", left_out), screen.columns - 1));
  }
  std::string result;
  for (const std::string& line : lines) result += line + "\n";
  return result;
}

}  // namespace sidestep
