// SPDX-License-Identifier: Apache-2.0
#include "common/config/yaml_map.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "common/config/scenario_loader.hpp"
#include "common/config/yaml_document.hpp"

namespace sidestep {
namespace {

std::string shown(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar: {
      const std::string text = node.Scalar().substr(0, 40);
      return "\"" + text + "\"";
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

std::string shown(Range range) { return fmt::format("{} to {}", range.low, range.high); }

/// Numbers are plain scalars: "3" in quotes or with a tag is text.
template <typename Number>
bool parse_plain(const YAML::Node& node, Number& value) {
  if (!node.IsScalar() || node.Tag() != "?") return false;
  const std::string& text = node.Scalar();
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end;
}

}  // namespace

void YamlPlace::refuse(const std::string& why) const {
  throw ScenarioError(file, line, what.empty() ? why : what + ": " + why);
}

YamlPlace YamlPlace::of(const YAML::Node& node, const std::string& name) const {
  const int own = node.IsDefined() ? node.Mark().line + 1 : 0;
  return {file, own > 0 ? own : line, name};
}

double number_from(const YAML::Node& node, const YamlPlace& place, Range range) {
  double value = 0;
  if (!parse_plain(node, value)) {
    place.refuse(fmt::format("expected a number from {}, got {}", shown(range), shown(node)));
  }
  if (!std::isfinite(value) || value < range.low || value > range.high) {
    place.refuse(fmt::format("expected {}, got {}", shown(range), value));
  }
  return value;
}

long integer_from(const YAML::Node& node, const YamlPlace& place, Range range) {
  long value = 0;
  if (!parse_plain(node, value)) {
    place.refuse(fmt::format("expected a whole number from {}, got {}", shown(range), shown(node)));
  }
  if (static_cast<double>(value) < range.low || static_cast<double>(value) > range.high) {
    place.refuse(fmt::format("expected {}, got {}", shown(range), value));
  }
  return value;
}

std::string text_from(const YAML::Node& node, const YamlPlace& place) {
  if (!node.IsScalar()) place.refuse("expected text, got " + shown(node));
  return node.Scalar();
}

std::vector<double> numbers_from(const YAML::Node& node, const YamlPlace& place, std::size_t least,
                                 std::size_t most, Range range) {
  const std::string length = least == most ? std::to_string(least) : fmt::format("{} to {}", least, most);
  if (!node.IsSequence())
    place.refuse(fmt::format("expected a list of {} numbers, got {}", length, shown(node)));
  if (node.size() < least || node.size() > most) {
    place.refuse(fmt::format("expected a list of {} numbers, got {}", length, node.size()));
  }
  std::vector<double> values;
  for (const auto& element : node)
    values.push_back(number_from(element, place.of(element, place.what), range));
  return values;
}

std::vector<YAML::Node> list_from(const YAML::Node& node, const YamlPlace& place, std::size_t most) {
  if (!node.IsSequence()) place.refuse("expected a list, got " + shown(node));
  if (node.size() > most)
    place.refuse(fmt::format("expected at most {} elements, got {}", most, node.size()));
  return {node.begin(), node.end()};
}

YamlMap::YamlMap(const YAML::Node& node, YamlPlace place) : node_(node), place_(std::move(place)) {
  if (!node_.IsMap()) place_.refuse("expected a mapping of keys to values, got " + shown(node_));
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const YamlPlace here = place_.of(entry.first, place_.what);
    if (!entry.first.IsScalar()) here.refuse("expected a key, got " + shown(entry.first));
    if (!seen.insert(entry.first.Scalar()).second) {
      here.refuse(fmt::format("key \"{}\" stands here twice, expected once", entry.first.Scalar()));
    }
  }
}

YAML::Node YamlMap::find(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  for (const auto& entry : node_) {
    if (entry.first.Scalar() == key) return entry.second;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

YAML::Node YamlMap::require(const std::string& key) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) place_.refuse(fmt::format("key \"{}\" is missing", key));
  return node;
}

YamlPlace YamlMap::place_of(const std::string& key) {
  const std::string name = place_.what.empty() ? key : place_.what + "." + key;
  for (const auto& entry : node_) {
    // The mark of an empty value is wherever the next token stands.
    if (entry.first.Scalar() == key)
      return place_.of(entry.second.IsNull() ? entry.first : entry.second, name);
  }
  return {place_.file, place_.line, name};
}

void YamlMap::read(const std::string& key, Range range, double& value) {
  const YAML::Node node = find(key);
  if (node.IsDefined()) value = number_from(node, place_of(key), range);
}

void YamlMap::read(const std::string& key, Range range, int& value) {
  const YAML::Node node = find(key);
  if (node.IsDefined()) value = static_cast<int>(integer_from(node, place_of(key), range));
}

void YamlMap::read(const std::string& key, Range range, Vec2& value) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  const auto numbers = numbers_from(node, place_of(key), 2, 2, range);
  value = {numbers[0], numbers[1]};
}

void YamlMap::read(const std::string& key, bool& value) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  const bool is_plain = node.IsScalar() && node.Tag() == "?";
  if (!is_plain || (node.Scalar() != "true" && node.Scalar() != "false")) {
    place_of(key).refuse("expected true or false, got " + shown(node));
  }
  value = node.Scalar() == "true";
}

void YamlMap::read_ms(const std::string& key, Range range_ms, Duration& value) {
  double milliseconds = to_seconds(value) * 1e3;
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return;
  read(key, range_ms, milliseconds);
  value = from_seconds(milliseconds * 1e-3);
}

void YamlMap::finish() const {
  for (const auto& entry : node_) {
    if (std::find(known_.begin(), known_.end(), entry.first.Scalar()) != known_.end()) continue;
    place_.of(entry.first, place_.what)
        .refuse(fmt::format("unknown key \"{}\", expected one of: {}", entry.first.Scalar().substr(0, 40),
                            fmt::join(known_, ", ")));
  }
}

YamlMap document_map(const std::string& text, const std::string& file_name, const std::string& expected) {
  const YAML::Node root = parse_yaml(text, file_name, expected);
  return {root, YamlPlace{file_name, 1, ""}.of(root, "")};
}

}  // namespace sidestep
