// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace sidestep {

/// Refuses YAML for which yaml-cpp would need far more memory than the permitted values do: it keeps all
/// tokens of a list in brackets, 240 bytes each, until it returns the first value. Counts the characters that
/// separate and enclose values, even in comments and quoted text, so no text has more tokens than are
/// counted. Throws ConfigError if there are more than two such characters for each of `max_values` values
/// ("[x, y]," has four for three values), or if the text is nested deeper than yaml-cpp reads.
void check_yaml_structure(const std::string& text, const std::string& file_name, std::size_t max_values);

}  // namespace sidestep
