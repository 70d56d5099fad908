// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "common/yaml/plus_sign.hpp"

namespace sidestep {

/// Quotes a value for a message, and truncates long values.
inline std::string in_quotes(const std::string& text) {
  constexpr std::size_t kMaxLength = 60;
  return fmt::format("\"{}\"", text.size() > kMaxLength ? text.substr(0, kMaxLength) + "..." : text);
}

/// Parses a number in decimal notation that is the whole text. A leading "+" is allowed; NaN and infinity are
/// not.
template <typename Number>
std::optional<Number> parsed(std::string_view text) {
  text = without_plus(text);
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(number)) return std::nullopt;
  }
  return number;
}

/// Whether the text is a whole number in decimal notation, of any size.
inline bool is_whole_number(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace sidestep
