// SPDX-License-Identifier: Apache-2.0
#include "common/json/json_text.hpp"

#include <nlohmann/json.hpp>

namespace sidestep {
namespace {

template <typename Json>
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string json_text(const nlohmann::json& json, int indent) { return text_of(json, indent); }

std::string json_text(const nlohmann::ordered_json& json, int indent) { return text_of(json, indent); }

nlohmann::json parse_json(std::string_view text, bool throws_errors) {
  return nlohmann::json::parse(text, nullptr, throws_errors);
}

nlohmann::ordered_json parse_ordered_json(std::string_view text, bool throws_errors) {
  return nlohmann::ordered_json::parse(text, nullptr, throws_errors);
}

}  // namespace sidestep
