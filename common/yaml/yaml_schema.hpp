// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/yaml/range.hpp"

namespace sidestep {

class YamlMap;

/// A JSON schema, draft 7, with which editors check and complete YAML files.
using JsonSchema = nlohmann::ordered_json;

// Schemas of single values. They accept whatever the readers of yaml_map.hpp accept.

[[nodiscard]] JsonSchema number_schema(Range range);
[[nodiscard]] JsonSchema integer_schema(Range range);
/// A heading in radians, at most a full turn in either direction.
[[nodiscard]] JsonSchema heading_schema();
[[nodiscard]] JsonSchema text_schema();
/// One of these names. A number within a name stands for any number.
[[nodiscard]] JsonSchema name_schema(std::span<const std::string> names);
[[nodiscard]] JsonSchema list_schema(const JsonSchema& element, std::size_t min_count, std::size_t max_count);
/// A list whose elements have one schema each, of which the last may be missing down to `min_count`.
[[nodiscard]] JsonSchema tuple_schema(const std::vector<JsonSchema>& elements, std::size_t min_count);
[[nodiscard]] JsonSchema any_schema_of(const std::vector<JsonSchema>& alternatives);

/// The mapping that `read` reads. `read` gets a map without content, on which every reader leaves its value
/// unchanged and records its key, and is called once for every combination of choices that it makes by
/// YamlMap::choose(). It must not reject the values that it starts with.
[[nodiscard]] JsonSchema mapping_schema(const std::function<void(YamlMap&)>& read);

/// The choices of one call of a mapping's reader: at the n-th choice it takes alternative taken[n].
class SchemaChoices {
 public:
  void restart() { next_ = 0; }
  /// The alternative to take, below `count`.
  std::size_t take(std::size_t count);
  /// Goes on to the next combination. Returns whether there is one.
  bool advance();

 private:
  struct Choice {
    std::size_t taken, count;
  };
  std::vector<Choice> choices_;
  std::size_t next_ = 0;
};

/// The keys of a mapping, as its reader asks for them.
class YamlSchema {
 public:
  explicit YamlSchema(SchemaChoices& choices);
  ~YamlSchema();
  YamlSchema(const YamlSchema&) = delete;
  YamlSchema& operator=(const YamlSchema&) = delete;

  /// A key whose value may be anything, unless another call says more.
  void mention(const std::string& key);
  void add(const std::string& key, const JsonSchema& value);
  void add_number(const std::string& key, Range range, double default_value);
  void add_integer(const std::string& key, Range range, int default_value);
  void add_point(const std::string& key, Range range, const Vec2& default_value);
  void add_names(const std::string& key, std::span<const std::string_view> names,
                 const std::string& default_value);
  void add_flag(const std::string& key, bool default_value);
  void add_mapping(const std::string& key, const std::function<void(YamlMap&)>& read);
  void add_list_of_mappings(const std::string& key, std::size_t min_count, std::size_t max_count,
                            const std::function<void(YamlMap&)>& read);
  void require(const std::string& key);
  void require_any(std::span<const std::string> keys);
  /// Requires the key that this call of the reader takes.
  const std::string& choose(std::span<const std::string> keys);

  [[nodiscard]] JsonSchema json() const;

 private:
  SchemaChoices& choices_;
  std::unique_ptr<JsonSchema> properties_;
  std::set<std::string> required_;
  std::vector<std::string> any_required_;
};

}  // namespace sidestep
