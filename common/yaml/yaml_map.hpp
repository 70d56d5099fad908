// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include <yaml-cpp/yaml.h>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"
#include "common/yaml/range.hpp"

namespace sidestep {

class YamlSchema;

/// A location in a YAML file, for error messages.
struct YamlLocation {
  std::string file;
  int line = 1;      ///< line number, counted from 1
  std::string what;  ///< the key, e.g. "vision.delay_ms"

  /// Throws a ConfigError for this location.
  [[noreturn]] void fail(const std::string& why) const;
  /// The location of a node within this one. A node without a position in the text keeps this line.
  YamlLocation of(const YAML::Node& node, const std::string& name) const;
};

// Readers of a single node. They throw a ConfigError for `location` if the node has the wrong type or is out
// of range.

/// A finite number.
[[nodiscard]] double number_from(const YAML::Node& node, const YamlLocation& location, Range range);
[[nodiscard]] long integer_from(const YAML::Node& node, const YamlLocation& location, Range range);
/// A heading in radians, at most a full turn in either direction.
[[nodiscard]] double heading_from(const YAML::Node& node, const YamlLocation& location);
/// Plain or quoted text, without zero bytes.
[[nodiscard]] std::string text_from(const YAML::Node& node, const YamlLocation& location);
/// A list of min_count to max_count numbers.
std::vector<double> numbers_from(const YAML::Node& node, const YamlLocation& location, std::size_t min_count,
                                 std::size_t max_count, Range range);
/// The elements of a list.
[[nodiscard]] std::vector<YAML::Node> list_from(const YAML::Node& node, const YamlLocation& location,
                                                std::size_t max_count);

/// Fails for a list of numbers where a list of such lists is expected: "goals_m: [3, 1]" for "[[3, 1]]".
void refuse_single_point(const YAML::Node& list, const YamlLocation& location);

/// Reads a YAML mapping strictly. A reader leaves the value unchanged if the key is missing. finish() rejects
/// all keys that were not read; the constructor rejects duplicate keys. All functions throw ConfigError.
///
/// A map that is made from a schema has no content: readers find no key, and record in the schema what they
/// would accept. So the same code reads files and describes them for editors.
class YamlMap {
 public:
  YamlMap(const YAML::Node& node, YamlLocation location);
  explicit YamlMap(YamlSchema& schema) : schema_(&schema) {}

  void read(const std::string& key, Range range, double& value);
  void read(const std::string& key, Range range, int& value);
  void read(const std::string& key, Range range, Vec2& value);
  /// Reads a value that must be one of these names.
  void read(const std::string& key, std::span<const std::string_view> names, std::string& value);
  /// Reads "true" or "false".
  void read(const std::string& key, bool& value);
  /// Reads a heading in radians, at most a full turn in either direction.
  void read_heading(const std::string& key, double& value_rad);
  /// Reads a duration in milliseconds, for keys that end in _ms.
  void read_ms(const std::string& key, Range range_ms, Duration& value);
  /// A finite number, a whole number, text, or a list of min_count to max_count numbers; nullopt if the key
  /// is missing.
  std::optional<double> number(const std::string& key, Range range);
  std::optional<long> integer(const std::string& key, Range range);
  std::optional<std::string> text(const std::string& key);
  std::optional<std::vector<double>> numbers(const std::string& key, std::size_t min_count,
                                             std::size_t max_count, Range range);
  /// A list of min_count to max_count points; empty if the key is missing.
  std::vector<Vec2> points(const std::string& key, std::size_t min_count, std::size_t max_count, Range range);
  /// A list of these names; empty if the key is missing.
  std::vector<std::string> names(const std::string& key, std::span<const std::string_view> names,
                                 std::size_t max_count);
  /// The value of a key; undefined if the key is missing.
  YAML::Node find(const std::string& key);
  /// The value of a required key.
  YAML::Node require(const std::string& key);
  /// The location of the key's value, or of the whole mapping if the key is missing.
  YamlLocation location_of(const std::string& key);
  const YamlLocation& location() const { return location_; }
  /// The keys that the mapping has, known or not.
  std::vector<std::string> keys() const;
  void finish() const;

  /// The schema that this map describes; null if it reads a file.
  YamlSchema* schema() const { return schema_; }

 private:
  YAML::Node node_;
  YamlLocation location_;
  std::vector<std::string> known_;
  YamlSchema* schema_ = nullptr;
};

/// The mapping at the root of a YAML text. `expected`, for example "a marker layout", and `file_name` appear
/// in error messages.
[[nodiscard]] YamlMap document_map(const std::string& text, const std::string& file_name,
                                   const std::string& expected);

/// Calls `read` for each mapping in the list under an optional key, which has min_count to max_count
/// elements, and rejects unknown keys in it.
void read_optional_list(YamlMap& map, const std::string& key, std::size_t min_count, std::size_t max_count,
                        const std::function<void(YamlMap&)>& read);
/// Calls `read` for each mapping in the list under a required key, which has 1 to max_count elements, and
/// rejects unknown keys in it.
void read_list(YamlMap& map, const std::string& key, std::size_t max_count,
               const std::function<void(YamlMap&)>& read);

/// Calls `read` for the mapping under an optional key, and rejects unknown keys in it.
void read_section(YamlMap& map, const std::string& key, const std::function<void(YamlMap&)>& read);

}  // namespace sidestep
