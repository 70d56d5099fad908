// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A place in a file: what errors say it about.
struct YamlPlace {
  std::string file;
  int line = 1;      ///< from 1
  std::string what;  ///< e.g. "vision.delay_ms"

  /// Throws a ScenarioError for this place.
  [[noreturn]] void refuse(const std::string& why) const;
  /// The place of a node within this one; nodes without a mark of their own keep this line.
  YamlPlace of(const YAML::Node& node, const std::string& name) const;
};

struct Range {
  double low;
  double high;
};

/// A finite number within a range, or a refusal.
double number_from(const YAML::Node& node, const YamlPlace& place, Range range);
/// A whole number within a range, or a refusal.
long integer_from(const YAML::Node& node, const YamlPlace& place, Range range);
/// Plain or quoted text, or a refusal.
std::string text_from(const YAML::Node& node, const YamlPlace& place);
/// A list of numbers whose length lies between least and most, or a refusal.
std::vector<double> numbers_from(const YAML::Node& node, const YamlPlace& place, std::size_t least,
                                 std::size_t most, Range range);
/// The elements of a list of at most `most`, or a refusal.
std::vector<YAML::Node> list_from(const YAML::Node& node, const YamlPlace& place, std::size_t most);

/// Reads one YAML mapping strictly. Each reader leaves the value alone when the key is missing; finish()
/// refuses every key that no reader asked for. Duplicate keys are refused at construction.
class YamlMap {
 public:
  YamlMap(const YAML::Node& node, YamlPlace place);

  void read(const std::string& key, Range range, double& value);
  void read(const std::string& key, Range range, int& value);
  void read(const std::string& key, Range range, Vec2& value);
  /// true or false.
  void read(const std::string& key, bool& value);
  /// The key's name ends in _ms.
  void read_ms(const std::string& key, Range range_ms, Duration& value);
  /// The value's node, undefined when the key is missing.
  YAML::Node find(const std::string& key);
  /// As find, but a missing key is refused.
  YAML::Node require(const std::string& key);
  /// Where the key's value stands, or the whole mapping when the key is missing.
  YamlPlace place_of(const std::string& key);
  const YamlPlace& place() const { return place_; }
  void finish() const;

 private:
  YAML::Node node_;
  YamlPlace place_;
  std::vector<std::string> known_;
};

/// The mapping that a YAML text is. `expected` ("a layout of markings") and `file_name` stand in messages.
YamlMap document_map(const std::string& text, const std::string& file_name, const std::string& expected);

/// Calls `read` on each mapping of the list under a key, of which there are at least one and at most `most`,
/// and refuses the keys that it does not ask for.
template <typename Read>
void read_list(YamlMap& map, const std::string& key, std::size_t most, Read read) {
  const YamlPlace place = map.place_of(key);
  const std::vector<YAML::Node> elements = list_from(map.require(key), place, most);
  if (elements.empty()) place.refuse("expected at least one element");
  for (std::size_t i = 0; i < elements.size(); ++i) {
    YamlMap inner(elements[i], place.of(elements[i], key + "[" + std::to_string(i) + "]"));
    read(inner);
    inner.finish();
  }
}

/// Calls `read` on the mapping under a key when it is there, and refuses the keys that it does not ask for.
template <typename Read>
void read_section(YamlMap& map, const std::string& key, Read read) {
  const YAML::Node node = map.find(key);
  if (!node.IsDefined()) return;
  YamlMap inner(node, map.place_of(key));
  read(inner);
  inner.finish();
}

}  // namespace sidestep
