// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/scenario_schema.hpp"

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "common/config/scenario_loader.hpp"
#include "common/yaml/yaml_map.hpp"
#include "common/yaml/yaml_schema.hpp"
#include "deploy/trial/scenario/key_descriptions.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"

namespace sidestep {
namespace {

/// Adds the descriptions of all keys in the schema. `path` is that of the mapping, for example
/// "vision.images.".
void describe(JsonSchema& schema, const std::string& path,
              const std::map<std::string, std::string>& descriptions) {
  if (schema.contains("anyOf")) {
    for (JsonSchema& alternative : schema["anyOf"]) describe(alternative, path, descriptions);
  }
  if (schema.contains("items") && schema["items"].is_object()) describe(schema["items"], path, descriptions);
  if (!schema.contains("properties")) return;
  for (auto& property : schema["properties"].items()) {
    const auto found = descriptions.find(path + property.key());
    if (found != descriptions.end() && !found->second.empty())
      property.value()["description"] = found->second;
    describe(property.value(), path + property.key() + ".", descriptions);
  }
}

}  // namespace

std::string scenario_schema() {
  JsonSchema keys = mapping_schema([](YamlMap& map) {
    describe_scenario(map);
    describe_fault_test(map);
  });
  describe(keys, "", key_descriptions(kKeysPage));
  JsonSchema schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Sidestep scenario"}};
  schema.update(keys);
  return schema.dump(1) + "\n";
}

std::string scenario_schema_path() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (const char* place : {"../share/sidestep/scenarios", "../../../deploy/scenarios"}) {
    const fs::path path = (program.parent_path() / place / "scenario.schema.json").lexically_normal();
    if (fs::exists(path, error)) return path.string();
  }
  return "";
}

}  // namespace sidestep
