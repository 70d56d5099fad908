// SPDX-License-Identifier: Apache-2.0
#include "common/file/xml_text.hpp"

#include <algorithm>

#include "common/file/utf8.hpp"

namespace sidestep {
namespace {

/// How XML writes a character that has a meaning of its own; empty for all others.
std::string_view reference_to(char c) {
  switch (c) {
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '&':
      return "&amp;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    case '\n':
      return "&#10;";
    case '\r':
      return "&#13;";
    case '\t':
      return "&#9;";
    default:
      return {};
  }
}

}  // namespace

std::string xml_escaped(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    const std::string_view reference = reference_to(text[at]);
    if (length == 0)
      result += kReplacementCharacter;
    else
      result += reference.empty() ? text.substr(at, length) : reference;
    at += std::max<std::size_t>(length, 1);
  }
  return result;
}

}  // namespace sidestep
