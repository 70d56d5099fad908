// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sidestep {

/// U+FFFD, which stands for what cannot be shown.
inline constexpr std::string_view kReplacementCharacter = "\xEF\xBF\xBD";

/// Length in bytes of the UTF-8 sequence (RFC 3629) that begins at `at`, which must be below the text's size.
/// 0 if no valid sequence begins there, or if it encodes a control character other than tab, newline and
/// carriage return, or a non-character that XML 1.0 excludes.
[[nodiscard]] std::size_t utf8_length(std::string_view text, std::size_t at);

/// Length in bytes of a character that can be part of a name: as utf8_length(), but 0 for ASCII white space
/// and for any control character.
[[nodiscard]] std::size_t printable_length(std::string_view text, std::size_t at);

/// A text of unknown origin as one line for a terminal: U+FFFD replaces control characters, line ends and
/// tabs among them, and bytes that are not UTF-8.
[[nodiscard]] std::string printable_line(std::string_view text);

}  // namespace sidestep
