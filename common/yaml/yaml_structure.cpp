// SPDX-License-Identifier: Apache-2.0
#include "common/yaml/yaml_structure.hpp"

#include <fmt/format.h>
#include <string_view>

#include "common/yaml/config_error.hpp"

namespace sidestep {
namespace {

/// Maximum nesting that yaml-cpp reads.
constexpr int kMaxNesting = 500;

/// Characters that begin, end or separate tokens within brackets. Dashes and line ends do so only outside
/// brackets, where yaml-cpp returns each value as it reads it.
constexpr std::string_view kStructure = "[]{},:?&*!'\"";

}  // namespace

void check_yaml_structure(const std::string& text, const std::string& file_name, std::size_t max_values) {
  const std::size_t max_structure = 2 * max_values;
  std::size_t structure = 0;
  int line = 1, nesting = 0;
  bool is_comment = false;    // possibly in a comment: characters are counted, but brackets do not nest
  bool is_directive = false;  // possibly in a directive, whose words yaml-cpp keeps
  char before = '\n';
  for (const char c : text) {
    if (c == '\n') {
      ++line;
      is_comment = is_directive = false;
    } else if (c == '#') {
      is_comment |= before == ' ' || before == '\t' || before == '\n';
    } else if (c == '%') {
      is_directive = true;
    } else if (kStructure.find(c) != std::string_view::npos || (is_directive && (c == ' ' || c == '\t'))) {
      if (++structure > max_structure)
        throw ConfigError(file_name, line,
                          fmt::format("more than {} of the characters {}, expected at most {} values",
                                      max_structure, kStructure, max_values));
      if (!is_comment && (c == '[' || c == '{') && ++nesting > kMaxNesting)
        throw ConfigError(file_name, line, fmt::format("expected at most {} nested brackets", kMaxNesting));
      if (!is_comment && (c == ']' || c == '}') && nesting > 0) --nesting;
    }
    before = c;
  }
}

}  // namespace sidestep
