// SPDX-License-Identifier: Apache-2.0
#include "common/file/utf8.hpp"

#include <algorithm>
#include <cstdint>

namespace sidestep {

std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  std::uint32_t code = first & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr std::uint32_t kShortest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  const bool is_valid = first >= 0xc2 && first < 0xf5 && code >= kShortest[length] && code <= 0x10ffff &&
                        !is_surrogate && code != 0xfffe && code != 0xffff;
  return is_valid ? length : 0;
}

std::size_t printable_length(std::string_view text, std::size_t at) {
  constexpr unsigned char kDelete = 0x7f, kC1Lead = 0xc2, kFirstC1Control = 0x80, kLastC1Control = 0x9f;
  const std::size_t length = utf8_length(text, at);
  const auto first = static_cast<unsigned char>(text[at]);
  if (length == 1) return first > ' ' && first != kDelete ? 1 : 0;
  const auto second = static_cast<unsigned char>(length > 1 ? text[at + 1] : 0);
  const bool is_control =
      length == 2 && first == kC1Lead && second >= kFirstC1Control && second <= kLastC1Control;
  return is_control ? 0 : length;
}

std::string printable_line(std::string_view text) {
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = text[at] == ' ' ? 1 : printable_length(text, at);
    line += length > 0 ? text.substr(at, length) : kReplacementCharacter;
    // A control character of several bytes is one character.
    at += std::max({length, utf8_length(text, at), std::size_t{1}});
  }
  return line;
}

}  // namespace sidestep
