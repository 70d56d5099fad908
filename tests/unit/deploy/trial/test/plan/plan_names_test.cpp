// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/plan_names.hpp"

#include <nlohmann/json.hpp>

#include "common/yaml/yaml_schema.hpp"
#include "tests/catch.hpp"

namespace sidestep::plan_names_test {

TEST_CASE("a schema of process names takes the first name, and an empty one if there is none") {
  std::string process;
  std::vector<std::string> processes;
  std::vector<std::string> names;
  const auto read = [&](YamlMap& map) {
    process = process_from(map, "kill", names);
    processes = processes_from(map, "pause", names);
  };
  CHECK(mapping_schema(read)["required"].size() == 2);
  CHECK(process.empty());
  CHECK(processes == std::vector<std::string>{""});
  names = {"vision", "agent 0"};
  CHECK(mapping_schema(read)["required"].size() == 2);
  CHECK(process == "vision");
  CHECK(processes == std::vector<std::string>{"vision"});
}

}  // namespace sidestep::plan_names_test
