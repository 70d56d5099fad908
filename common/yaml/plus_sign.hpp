// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace sidestep {

/// The text of a number without its leading plus sign, which people and YAML's core schema write, but
/// std::from_chars refuses. A plus sign that no digit or point follows is kept, so that the text is refused.
[[nodiscard]] inline std::string_view without_plus(std::string_view text) {
  if (text.size() < 2 || text[0] != '+') return text;
  const bool is_number = text[1] == '.' || (text[1] >= '0' && text[1] <= '9');
  return is_number ? text.substr(1) : text;
}

}  // namespace sidestep
