// SPDX-License-Identifier: Apache-2.0
#include "common/yaml/yaml_schema.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numbers>

#include "common/yaml/yaml_map.hpp"

namespace sidestep {
namespace {

/// The name as a regular expression in which every number may be any other.
std::string name_pattern(const std::string& name) {
  std::string pattern;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool is_digit = std::isdigit(static_cast<unsigned char>(name[i])) != 0;
    if (!is_digit) {
      if (name[i] == '(' || name[i] == ')' || name[i] == '.') pattern += '\\';
      pattern += name[i];
    } else if (i == 0 || std::isdigit(static_cast<unsigned char>(name[i - 1])) == 0) {
      pattern += "[0-9]+";
    }
  }
  return pattern;
}

void add_default(JsonSchema& schema, const JsonSchema& value) { schema["default"] = value; }

}  // namespace

JsonSchema number_schema(Range range) {
  return {{"type", "number"}, {"minimum", range.low}, {"maximum", range.high}};
}

JsonSchema integer_schema(Range range) {
  return {{"type", "integer"},
          {"minimum", static_cast<std::int64_t>(range.low)},
          {"maximum", static_cast<std::int64_t>(range.high)}};
}

JsonSchema heading_schema() { return number_schema({-2 * std::numbers::pi, 2 * std::numbers::pi}); }

// Readers take 12 and true for text, too.
JsonSchema text_schema() { return {{"type", JsonSchema::array({"string", "number", "boolean"})}}; }

JsonSchema name_schema(std::span<const std::string> names) {
  std::vector<std::string> patterns;
  for (const std::string& name : names) {
    const std::string pattern = name_pattern(name);
    if (std::ranges::find(patterns, pattern) == patterns.end()) patterns.push_back(pattern);
  }
  const bool has_numbers =
      std::ranges::any_of(names, [](const std::string& name) { return name_pattern(name) != name; });
  if (!has_numbers) return {{"enum", patterns}};
  std::string all;
  for (const std::string& pattern : patterns) all += (all.empty() ? "" : "|") + pattern;
  return {{"type", "string"}, {"pattern", "^(" + all + ")$"}};
}

JsonSchema list_schema(const JsonSchema& element, std::size_t min_count, std::size_t max_count) {
  return {{"type", "array"}, {"items", element}, {"minItems", min_count}, {"maxItems", max_count}};
}

JsonSchema tuple_schema(const std::vector<JsonSchema>& elements, std::size_t min_count) {
  return {{"type", "array"}, {"items", elements}, {"minItems", min_count}, {"maxItems", elements.size()}};
}

JsonSchema any_schema_of(const std::vector<JsonSchema>& alternatives) {
  if (alternatives.size() == 1) return alternatives.front();
  JsonSchema schema;
  schema["anyOf"] = alternatives;
  return schema;
}

JsonSchema mapping_schema(const std::function<void(YamlMap&)>& read) {
  SchemaChoices choices;
  std::vector<JsonSchema> alternatives;
  do {
    choices.restart();
    YamlSchema schema(choices);
    YamlMap map(schema);
    read(map);
    alternatives.push_back(schema.json());
  } while (choices.advance());
  return any_schema_of(alternatives);
}

std::size_t SchemaChoices::take(std::size_t count) {
  if (next_ == choices_.size()) choices_.push_back({0, count});
  return choices_[next_++].taken;
}

bool SchemaChoices::advance() {
  while (!choices_.empty() && choices_.back().taken + 1 == choices_.back().count) choices_.pop_back();
  if (choices_.empty()) return false;
  ++choices_.back().taken;
  return true;
}

YamlSchema::YamlSchema(SchemaChoices& choices)
    : choices_(choices), properties_(std::make_unique<JsonSchema>(JsonSchema::object())) {}
YamlSchema::~YamlSchema() = default;

void YamlSchema::mention(const std::string& key) {
  if (!properties_->contains(key)) add(key, JsonSchema::object());
}

void YamlSchema::add(const std::string& key, const JsonSchema& value) { (*properties_)[key] = value; }

// A value outside the range is no default: the key is required, or its absence means something else.
void YamlSchema::add_number(const std::string& key, Range range, double default_value) {
  JsonSchema schema = number_schema(range);
  if (default_value >= range.low && default_value <= range.high) add_default(schema, default_value);
  add(key, schema);
}

void YamlSchema::add_integer(const std::string& key, Range range, int default_value) {
  JsonSchema schema = integer_schema(range);
  if (default_value >= range.low && default_value <= range.high) add_default(schema, default_value);
  add(key, schema);
}

void YamlSchema::add_point(const std::string& key, Range range, const Vec2& default_value) {
  JsonSchema schema = list_schema(number_schema(range), 2, 2);
  add_default(schema, JsonSchema::array({default_value.x(), default_value.y()}));
  add(key, schema);
}

void YamlSchema::add_names(const std::string& key, std::span<const std::string_view> names,
                           const std::string& default_value) {
  JsonSchema schema{{"enum", std::vector<std::string>(names.begin(), names.end())}};
  if (!default_value.empty()) add_default(schema, default_value);
  add(key, schema);
}

void YamlSchema::add_flag(const std::string& key, bool default_value) {
  add(key, {{"type", "boolean"}, {"default", default_value}});
}

void YamlSchema::add_mapping(const std::string& key, const std::function<void(YamlMap&)>& read) {
  add(key, mapping_schema(read));
}

void YamlSchema::add_list_of_mappings(const std::string& key, std::size_t min_count, std::size_t max_count,
                                      const std::function<void(YamlMap&)>& read) {
  add(key, list_schema(mapping_schema(read), min_count, max_count));
}

void YamlSchema::require(const std::string& key) {
  mention(key);
  required_.insert(key);
}

void YamlSchema::require_any(std::span<const std::string> keys) {
  any_required_.assign(keys.begin(), keys.end());
}

const std::string& YamlSchema::choose(std::span<const std::string> keys) {
  const std::string& key = keys[choices_.take(keys.size())];
  require(key);
  return key;
}

JsonSchema YamlSchema::json() const {
  JsonSchema schema{{"type", "object"}, {"properties", *properties_}};
  for (const std::string& key : required_) schema["properties"][key].erase("default");
  if (!required_.empty()) schema["required"] = required_;
  for (const std::string& key : any_required_)
    schema["anyOf"].push_back({{"required", JsonSchema::array({key})}});
  schema["additionalProperties"] = false;
  return schema;
}

}  // namespace sidestep
