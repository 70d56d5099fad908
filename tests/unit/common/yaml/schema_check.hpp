// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <yaml-cpp/yaml.h>

namespace sidestep {

using Json = nlohmann::ordered_json;

/// A YAML node as an editor sees it: plain scalars are numbers, booleans or null if they look so.
inline Json json_of(const YAML::Node& node) {
  if (node.IsMap()) {
    Json object = Json::object();
    for (const auto& entry : node) object[entry.first.Scalar()] = json_of(entry.second);
    return object;
  }
  if (node.IsSequence()) {
    Json list = Json::array();
    for (const auto& element : node) list.push_back(json_of(element));
    return list;
  }
  if (!node.IsScalar()) return nullptr;
  const std::string text = node.Scalar();
  if (node.Tag() == "!") return text;
  if (text == "true" || text == "false") return text == "true";
  static const std::regex kWhole("[-+]?[0-9]+"),
      kNumber("[-+]?(\\.[0-9]+|[0-9]+(\\.[0-9]*)?)([eE][-+]?[0-9]+)?");
  if (std::regex_match(text, kWhole) && text.size() < 18) return std::stol(text);
  if (std::regex_match(text, kNumber)) return std::strtod(text.c_str(), nullptr);
  return text;
}

inline bool has_type(const Json& value, const std::string& type) {
  if (type == "integer") return value.is_number() && value.get<double>() == std::floor(value.get<double>());
  if (type == "number") return value.is_number();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "array") return value.is_array();
  return type == "object" && value.is_object();
}

/// Why a value does not fit a schema; empty if it fits. Knows the words of draft 7 that YamlSchema uses, and
/// calls any other a problem. It shares no code with the loader.
inline std::string schema_problem(const Json& schema, const Json& value, const std::string& at = "") {
  for (const auto& rule : schema.items()) {
    const std::string& word = rule.key();
    const Json& limit = rule.value();
    const auto fails = [&] { return at + ": " + word + " " + limit.dump().substr(0, 200); };
    if (word == "type") {
      const Json types = limit.is_array() ? limit : Json::array({limit});
      if (!std::ranges::any_of(types, [&](const Json& type) { return has_type(value, type); }))
        return fails();
    } else if (word == "enum") {
      if (std::ranges::find(limit, value) == limit.end()) return fails();
    } else if (word == "const") {
      if (value != limit) return fails();
    } else if (word == "minimum" || word == "maximum") {
      if (!value.is_number()) continue;
      const double number = value, bound = limit;
      if (word == "minimum" ? number < bound : number > bound) return fails();
    } else if (word == "pattern") {
      if (value.is_string() &&
          !std::regex_search(value.get<std::string>(), std::regex(limit.get<std::string>())))
        return fails();
    } else if (word == "minItems" || word == "maxItems") {
      if (!value.is_array()) continue;
      const std::size_t count = limit;
      if (word == "minItems" ? value.size() < count : value.size() > count) return fails();
    } else if (word == "items") {
      if (!value.is_array()) continue;
      for (std::size_t i = 0; i < value.size(); ++i) {
        if (limit.is_array() && i >= limit.size()) break;
        const std::string problem =
            schema_problem(limit.is_array() ? limit[i] : limit, value[i], at + "[" + std::to_string(i) + "]");
        if (!problem.empty()) return problem;
      }
    } else if (word == "properties") {
      if (!value.is_object()) continue;
      for (const auto& entry : value.items()) {
        if (!limit.contains(entry.key())) continue;
        const std::string problem = schema_problem(limit[entry.key()], entry.value(), at + "." + entry.key());
        if (!problem.empty()) return problem;
      }
    } else if (word == "required") {
      for (const Json& key : limit)
        if (value.is_object() && !value.contains(key.get<std::string>())) return fails();
    } else if (word == "additionalProperties") {
      if (limit != false) return "unknown rule " + word;
      if (!value.is_object()) continue;
      for (const auto& entry : value.items())
        if (!schema["properties"].contains(entry.key())) return at + ": unknown key " + entry.key();
    } else if (word == "anyOf") {
      if (std::ranges::none_of(limit,
                               [&](const Json& one) { return schema_problem(one, value, at).empty(); }))
        return fails();
    } else if (word != "default" && word != "description" && word != "title" && word != "$schema") {
      return "unknown rule " + word;
    }
  }
  return "";
}

}  // namespace sidestep
