// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/url.hpp"

#include <charconv>

namespace sidestep {
namespace {

std::optional<std::string> decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i] == '+' ? ' ' : text[i];
      continue;
    }
    unsigned value = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (digits.size() < 2 || end.ptr != digits.data() + 2 || value == 0) return std::nullopt;
    result += static_cast<char>(value);
    i += 2;
  }
  return result;
}

}  // namespace

std::optional<Url> parse_target(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  Url url;
  const std::size_t question = target.find('?');
  const auto path = decoded(target.substr(0, question));
  if (!path) return std::nullopt;
  url.path = *path;
  if (question == std::string_view::npos) return url;
  std::string_view rest = target.substr(question + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    const auto key = decoded(pair.substr(0, equals));
    const auto value = decoded(equals == std::string_view::npos ? "" : pair.substr(equals + 1));
    if (!key || !value) return std::nullopt;
    url.query[*key] = *value;
  }
  return url;
}

}  // namespace sidestep
