// SPDX-License-Identifier: Apache-2.0
#include "common/yaml/yaml_map.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "common/file/similar_name.hpp"
#include "common/yaml/config_error.hpp"
#include "common/yaml/heading.hpp"
#include "common/yaml/plus_sign.hpp"
#include "common/yaml/yaml_document.hpp"
#include "common/yaml/yaml_schema.hpp"

namespace sidestep {
namespace {

std::string described(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar: {
      const std::string text = node.Scalar().substr(0, 40);
      return "\"" + text + (node.Tag() == "!" ? "\" in quotes" : "\"");
    }
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a mapping";
    case YAML::NodeType::Null:
      return "nothing";
    case YAML::NodeType::Undefined:
      break;
  }
  return "nothing";
}

std::string described(Range range) { return fmt::format("{:.10g} to {:.10g}", range.low, range.high); }

/// A number is a plain scalar: "3" in quotes or with a tag is text. Accepts a plus sign, like YAML's core
/// schema.
template <typename Number>
bool parse_plain(const YAML::Node& node, Number& value) {
  if (!node.IsScalar() || node.Tag() != "?") return false;
  const std::string_view text = without_plus(node.Scalar());
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end;
}

std::string name_from(const YAML::Node& node, const YamlLocation& location,
                      std::span<const std::string_view> names) {
  const std::string name = text_from(node, location);
  if (std::ranges::find(names, name) == names.end())
    location.fail(fmt::format("expected one of {}, got \"{}\"{}", fmt::join(names, ", "), name.substr(0, 40),
                              did_you_mean(name, std::vector<std::string>(names.begin(), names.end()))));
  return name;
}

}  // namespace

void YamlLocation::fail(const std::string& why) const {
  throw ConfigError(file, line, what.empty() ? why : what + ": " + why);
}

YamlLocation YamlLocation::of(const YAML::Node& node, const std::string& name) const {
  const int node_line = node.IsDefined() ? node.Mark().line + 1 : 0;
  return {file, node_line > 0 ? node_line : line, name};
}

double number_from(const YAML::Node& node, const YamlLocation& location, Range range) {
  double value = 0;
  if (!parse_plain(node, value)) {
    location.fail(fmt::format("expected a number from {}, got {}", described(range), described(node)));
  }
  if (!std::isfinite(value) || value < range.low || value > range.high) {
    location.fail(fmt::format("expected {}, got {}", described(range), value));
  }
  return value;
}

double heading_from(const YAML::Node& node, const YamlLocation& location) {
  double value_rad = 0;
  if (!parse_plain(node, value_rad)) location.fail("expected a heading in radians, got " + described(node));
  if (const std::string problem = heading_problem(value_rad); !problem.empty()) location.fail(problem);
  return value_rad;
}

long integer_from(const YAML::Node& node, const YamlLocation& location, Range range) {
  long value = 0;
  if (!parse_plain(node, value)) {
    location.fail(fmt::format("expected a whole number from {}, got {}", described(range), described(node)));
  }
  if (static_cast<double>(value) < range.low || static_cast<double>(value) > range.high) {
    location.fail(fmt::format("expected {}, got {}", described(range), value));
  }
  return value;
}

std::string text_from(const YAML::Node& node, const YamlLocation& location) {
  if (!node.IsScalar()) location.fail("expected text, got " + described(node));
  // C functions would stop at a zero byte, and thus read less than the text that was checked.
  if (node.Scalar().find('\0') != std::string::npos) location.fail("expected text without zero bytes");
  return node.Scalar();
}

std::vector<double> numbers_from(const YAML::Node& node, const YamlLocation& location, std::size_t min_count,
                                 std::size_t max_count, Range range) {
  const std::string length =
      min_count == max_count ? std::to_string(min_count) : fmt::format("{} to {}", min_count, max_count);
  if (!node.IsSequence())
    location.fail(fmt::format("expected a list of {} numbers, got {}", length, described(node)));
  if (node.size() < min_count || node.size() > max_count) {
    location.fail(fmt::format("expected a list of {} numbers, got {}", length, node.size()));
  }
  std::vector<double> values;
  for (const auto& element : node)
    values.push_back(number_from(element, location.of(element, location.what), range));
  return values;
}

std::vector<YAML::Node> list_from(const YAML::Node& node, const YamlLocation& location,
                                  std::size_t max_count) {
  if (!node.IsSequence()) location.fail("expected a list, got " + described(node));
  if (node.size() > max_count)
    location.fail(fmt::format("expected at most {} elements, got {}", max_count, node.size()));
  return {node.begin(), node.end()};
}

void refuse_single_point(const YAML::Node& list, const YamlLocation& location) {
  if (list.IsSequence() && list.size() > 0 && list[0].IsScalar())
    location.fail(fmt::format("expected a list of points, e.g. [[3, 1]], got {} in place of the first",
                              described(list[0])));
}

YamlMap::YamlMap(const YAML::Node& node, YamlLocation location)
    : node_(node), location_(std::move(location)) {
  if (!node_.IsMap()) location_.fail("expected a mapping of keys to values, got " + described(node_));
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const YamlLocation here = location_.of(entry.first, location_.what);
    if (!entry.first.IsScalar()) here.fail("expected a key, got " + described(entry.first));
    if (!seen.insert(entry.first.Scalar()).second) {
      here.fail(fmt::format("duplicate key \"{}\"", entry.first.Scalar()));
    }
  }
}

YAML::Node YamlMap::find(const std::string& key) {
  if (schema_) schema_->mention(key);
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  for (const auto& entry : node_) {
    if (entry.first.Scalar() == key) return entry.second;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

YAML::Node YamlMap::require(const std::string& key) {
  const YAML::Node node = find(key);
  if (schema_) {
    schema_->require(key);
    return node;
  }
  if (!node.IsDefined()) location_.fail(fmt::format("key \"{}\" is missing", key));
  return node;
}

YamlLocation YamlMap::location_of(const std::string& key) {
  const std::string name = location_.what.empty() ? key : location_.what + "." + key;
  for (const auto& entry : node_) {
    // For an empty value, yaml-cpp reports the position of the next token.
    if (entry.first.Scalar() == key)
      return location_.of(entry.second.IsNull() ? entry.first : entry.second, name);
  }
  return {location_.file, location_.line, name};
}

void YamlMap::read(const std::string& key, Range range, double& value) {
  if (schema_) return schema_->add_number(key, range, value);
  const YAML::Node node = find(key);
  if (node.IsDefined()) value = number_from(node, location_of(key), range);
}

void YamlMap::read(const std::string& key, Range range, int& value) {
  if (schema_) return schema_->add_integer(key, range, value);
  const YAML::Node node = find(key);
  if (node.IsDefined()) value = static_cast<int>(integer_from(node, location_of(key), range));
}

void YamlMap::read(const std::string& key, Range range, Vec2& value) {
  if (schema_) return schema_->add_point(key, range, value);
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  const auto numbers = numbers_from(node, location_of(key), 2, 2, range);
  value = {numbers[0], numbers[1]};
}

void YamlMap::read(const std::string& key, std::span<const std::string_view> names, std::string& value) {
  if (schema_) return schema_->add_names(key, names, value);
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  value = name_from(node, location_of(key), names);
}

void YamlMap::read(const std::string& key, bool& value) {
  if (schema_) return schema_->add_flag(key, value);
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  const bool is_plain = node.IsScalar() && node.Tag() == "?";
  if (!is_plain || (node.Scalar() != "true" && node.Scalar() != "false")) {
    location_of(key).fail("expected true or false, got " + described(node));
  }
  value = node.Scalar() == "true";
}

void YamlMap::read_heading(const std::string& key, double& value_rad) {
  if (schema_) return schema_->add(key, heading_schema());
  const YAML::Node node = find(key);
  if (node.IsDefined()) value_rad = heading_from(node, location_of(key));
}

void YamlMap::read_ms(const std::string& key, Range range_ms, Duration& value) {
  double milliseconds = std::round(to_seconds(value) * 1e9) / 1e6;
  if (schema_) return schema_->add_number(key, range_ms, milliseconds);
  if (!find(key).IsDefined()) return;
  read(key, range_ms, milliseconds);
  value = from_seconds(milliseconds * 1e-3);
}

std::optional<double> YamlMap::number(const std::string& key, Range range) {
  const YAML::Node node = find(key);
  if (schema_) schema_->add(key, number_schema(range));
  if (!node.IsDefined()) return std::nullopt;
  return number_from(node, location_of(key), range);
}

std::optional<long> YamlMap::integer(const std::string& key, Range range) {
  const YAML::Node node = find(key);
  if (schema_) schema_->add(key, integer_schema(range));
  if (!node.IsDefined()) return std::nullopt;
  return integer_from(node, location_of(key), range);
}

std::optional<std::string> YamlMap::text(const std::string& key) {
  const YAML::Node node = find(key);
  if (schema_) schema_->add(key, text_schema());
  if (!node.IsDefined()) return std::nullopt;
  return text_from(node, location_of(key));
}

std::optional<std::vector<double>> YamlMap::numbers(const std::string& key, std::size_t min_count,
                                                    std::size_t max_count, Range range) {
  const YAML::Node node = find(key);
  if (schema_) schema_->add(key, list_schema(number_schema(range), min_count, max_count));
  if (!node.IsDefined()) return std::nullopt;
  return numbers_from(node, location_of(key), min_count, max_count, range);
}

std::vector<Vec2> YamlMap::points(const std::string& key, std::size_t min_count, std::size_t max_count,
                                  Range range) {
  const YAML::Node node = find(key);
  if (schema_) schema_->add(key, list_schema(list_schema(number_schema(range), 2, 2), min_count, max_count));
  std::vector<Vec2> points;
  if (!node.IsDefined()) return points;
  const YamlLocation location = location_of(key);
  refuse_single_point(node, location);
  for (const YAML::Node& element : list_from(node, location, max_count)) {
    const auto numbers = numbers_from(element, location.of(element, location.what), 2, 2, range);
    points.emplace_back(numbers[0], numbers[1]);
  }
  if (points.size() < min_count) {
    location.fail(min_count == 1 ? "expected at least one point"
                                 : fmt::format("expected at least {} points", min_count));
  }
  return points;
}

std::vector<std::string> YamlMap::names(const std::string& key, std::span<const std::string_view> names,
                                        std::size_t max_count) {
  const YAML::Node node = find(key);
  if (schema_)
    schema_->add(
        key, list_schema(name_schema(std::vector<std::string>(names.begin(), names.end())), 0, max_count));
  std::vector<std::string> found;
  if (!node.IsDefined()) return found;
  const YamlLocation location = location_of(key);
  for (const YAML::Node& element : list_from(node, location, max_count))
    found.push_back(name_from(element, location.of(element, location.what), names));
  return found;
}

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : node_) keys.push_back(entry.first.Scalar());
  return keys;
}

void YamlMap::finish() const {
  for (const auto& entry : node_) {
    if (std::find(known_.begin(), known_.end(), entry.first.Scalar()) != known_.end()) continue;
    location_.of(entry.first, location_.what)
        .fail(fmt::format("unknown key \"{}\", expected one of: {}{}", entry.first.Scalar().substr(0, 40),
                          fmt::join(known_, ", "), did_you_mean(entry.first.Scalar(), known_)));
  }
}

void read_optional_list(YamlMap& map, const std::string& key, std::size_t min_count, std::size_t max_count,
                        const std::function<void(YamlMap&)>& read) {
  if (YamlSchema* const schema = map.schema())
    return schema->add_list_of_mappings(key, min_count, max_count, read);
  const YAML::Node node = map.find(key);
  if (!node.IsDefined()) return;
  const YamlLocation location = map.location_of(key);
  const std::vector<YAML::Node> elements = list_from(node, location, max_count);
  if (elements.size() < min_count) location.fail("expected at least one element");
  for (std::size_t i = 0; i < elements.size(); ++i) {
    YamlMap inner(elements[i], location.of(elements[i], fmt::format("{}[{}]", location.what, i)));
    read(inner);
    inner.finish();
  }
}

void read_list(YamlMap& map, const std::string& key, std::size_t max_count,
               const std::function<void(YamlMap&)>& read) {
  (void)map.require(key);
  read_optional_list(map, key, 1, max_count, read);
}

void read_section(YamlMap& map, const std::string& key, const std::function<void(YamlMap&)>& read) {
  if (YamlSchema* const schema = map.schema()) return schema->add_mapping(key, read);
  const YAML::Node node = map.find(key);
  if (!node.IsDefined()) return;
  YamlMap inner(node, map.location_of(key));
  read(inner);
  inner.finish();
}

YamlMap document_map(const std::string& text, const std::string& file_name, const std::string& expected) {
  const YAML::Node root = parse_yaml(text, file_name, expected);
  return {root, YamlLocation{file_name, 1, ""}.of(root, "")};
}

}  // namespace sidestep
