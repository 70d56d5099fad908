// SPDX-License-Identifier: Apache-2.0
#include "common/json/json_text.hpp"

#include <array>
#include <nlohmann/json.hpp>

namespace sidestep {
namespace {

template <typename Json>
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

constexpr std::size_t kMaxDepth = 100, kMaxKeys = 10'000;

/// The text up to the place where it nests too deeply, or where an object has more than `max_keys` keys. If
/// anything is cut off, the rest is not JSON, because an array or object is left open.
std::string_view parsable_part(std::string_view text, std::size_t max_keys) {
  std::array<std::size_t, kMaxDepth> commas{};  // in the arrays and objects that are open
  std::array<bool, kMaxDepth> is_object{};
  std::size_t depth = 0;
  bool is_in_string = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (is_in_string) {
      if (c == '\\') ++at;
      if (c == '"') is_in_string = false;
    } else if (c == '"') {
      is_in_string = true;
    } else if (c == '[' || c == '{') {
      if (depth == kMaxDepth) return text.substr(0, at);
      commas[depth] = 0;
      is_object[depth++] = c == '{';
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    } else if (c == ',' && depth > 0 && ++commas[depth - 1] >= max_keys && is_object[depth - 1]) {
      return text.substr(0, at);
    }
  }
  return text;
}

}  // namespace

std::string json_text(const nlohmann::json& json, int indent) { return text_of(json, indent); }

std::string json_text(const nlohmann::ordered_json& json, int indent) { return text_of(json, indent); }

nlohmann::json parse_json(std::string_view text, bool throws_errors) {
  const std::size_t unlimited = text.size() + 1;
  return nlohmann::json::parse(parsable_part(text, unlimited), nullptr, throws_errors);
}

nlohmann::ordered_json parse_ordered_json(std::string_view text, bool throws_errors) {
  return nlohmann::ordered_json::parse(parsable_part(text, kMaxKeys), nullptr, throws_errors);
}

}  // namespace sidestep
