// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/key_descriptions.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

namespace sidestep {
namespace {

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// The cells of a table's row; empty if the line is no row.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  if (!line.starts_with('|')) return cells;
  std::istringstream text(line.substr(1));
  for (std::string cell; std::getline(text, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

/// The texts between backticks.
std::vector<std::string> code_of(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  std::string part;
  for (bool is_code = false; std::getline(stream, part, '`'); is_code = !is_code) {
    if (is_code) parts.push_back(part);
  }
  return parts;
}

/// Text without backticks, and with the words of links instead of the links.
std::string plain(const std::string& markdown) {
  std::string text;
  for (std::size_t at = 0; at < markdown.size(); ++at) {
    const std::size_t middle = markdown[at] == '[' ? markdown.find("](", at) : std::string::npos;
    const std::size_t next = markdown.find('[', at + 1);
    if (middle == std::string::npos || (next != std::string::npos && next < middle)) {
      if (markdown[at] != '`') text += markdown[at];
      continue;
    }
    text += plain(markdown.substr(at + 1, middle - at - 1));
    at = std::min(markdown.find(')', middle), markdown.size() - 1);
  }
  return text;
}

/// The keys that a row is about: of `kill: PROCESS` the part before the colon.
std::vector<std::string> keys_of(const std::string& cell) {
  std::vector<std::string> keys, with_value;
  for (const std::string& code : code_of(cell)) {
    const std::size_t colon = code.find(':');
    (colon == std::string::npos ? keys : with_value).push_back(code.substr(0, colon));
  }
  return with_value.empty() ? keys : with_value;
}

/// The last column says what a key means, or does; the others are named.
std::string description(const std::vector<std::string>& header, const std::vector<std::string>& cells) {
  std::string text = plain(cells.back()), facts;
  for (std::size_t i = 1; i + 1 < cells.size() && i + 1 < header.size(); ++i) {
    if (cells[i].empty()) continue;
    facts += (facts.empty() ? "" : "; ") + header[i] + ": " + plain(cells[i]);
  }
  if (facts.empty()) return text;
  return text.empty() ? facts : text + " (" + facts + ")";
}

}  // namespace

std::map<std::string, std::string> key_descriptions(const std::string& markdown) {
  std::map<std::string, std::string> descriptions;
  std::string prefix;
  std::vector<std::string> header;
  std::istringstream text(markdown);
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with('#')) {
      const auto code = code_of(line);
      prefix = code.empty() ? "" : code.front() + ".";
    }
    const std::vector<std::string> cells = cells_of(line);
    if (cells.empty()) {
      header.clear();
    } else if (header.empty()) {
      header = cells;
    } else if (!cells.front().starts_with('-')) {
      for (const std::string& key : keys_of(cells.front()))
        descriptions[prefix + key] = description(header, cells);
    }
  }
  return descriptions;
}

}  // namespace sidestep
