// SPDX-License-Identifier: Apache-2.0
#include "common/yaml/yaml_merge.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "common/yaml/config_error.hpp"

namespace sidestep {
namespace {

/// Aliases can nest more deeply than the text.
constexpr int kMaxDepth = 1000;

/// In quotes or with a tag, "<<" is an ordinary key.
bool is_merge_key(const YAML::Node& key) {
  return key.IsScalar() && key.Scalar() == "<<" &&
         (key.Tag() == "?" || key.Tag() == "tag:yaml.org,2002:merge");
}

class Merger {
 public:
  explicit Merger(const std::string& file_name) : file_name_(file_name) {}

  void apply(const YAML::Node& node, int depth) {
    if (depth > kMaxDepth) fail(node, "nested too deeply for merge keys");
    if (node.IsSequence())
      for (const YAML::Node& element : node) apply(element, depth + 1);
    if (!node.IsMap()) return;
    for (const auto& entry : node) apply(entry.second, depth + 1);
    merge_into(node);
  }

 private:
  [[noreturn]] void fail(const YAML::Node& node, const std::string& why) const {
    throw ConfigError(file_name_, std::max(1, node.Mark().line + 1), why);
  }

  /// The mappings listed under a merge key.
  std::vector<YAML::Node> sources_of(const YAML::Node& key, const YAML::Node& value) const {
    std::vector<YAML::Node> sources;
    if (value.IsSequence())
      for (const YAML::Node& element : value) sources.push_back(element);
    else
      sources.push_back(value);
    for (const YAML::Node& source : sources)
      if (!source.IsMap()) fail(key, "<<: expected a mapping, or a list of mappings, to merge");
    return sources;
  }

  void merge_into(YAML::Node map) const {
    bool has_merge_key = false;
    YAML::Node merge_key;
    std::vector<YAML::Node> sources;
    std::set<std::string> own;
    for (const auto& entry : map) {
      if (!is_merge_key(entry.first)) {
        if (entry.first.IsScalar()) own.insert(entry.first.Scalar());
        continue;
      }
      if (has_merge_key) fail(entry.first, "duplicate key \"<<\", expected one with a list of mappings");
      has_merge_key = true;
      merge_key.reset(entry.first);
      sources = sources_of(entry.first, entry.second);
    }
    if (!has_merge_key) return;
    map.remove(merge_key);
    for (const YAML::Node& source : sources) {
      for (const auto& entry : source)
        if (!entry.first.IsScalar() || own.insert(entry.first.Scalar()).second)
          map.force_insert(entry.first, entry.second);
    }
  }

  const std::string& file_name_;
};

}  // namespace

void apply_merge_keys(const YAML::Node& root, const std::string& file_name) {
  Merger(file_name).apply(root, 0);
}

}  // namespace sidestep
