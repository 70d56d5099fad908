// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/fault_test.hpp"

#include <filesystem>

#include "common/config/scenario_loader.hpp"
#include "common/yaml/yaml_document.hpp"
#include "deploy/trial/test/plan/expectation_reader.hpp"
#include "deploy/trial/test/plan/fault_reader.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpectedTest = "a scenario with the key expect";

}  // namespace

FaultTest parse_fault_test(const std::string& text, const std::string& file) {
  FaultTest test{file, parse_scenario(text, file), {}, {}};
  YamlMap map = document_map(text, file, kExpectedTest);
  const std::string folder = std::filesystem::path(file).parent_path().string();
  test.faults = read_faults(map, test.scenario, folder);
  (void)map.require("expect");
  test.expectations = read_expectations(map, test.scenario, test.faults);
  return test;
}

void describe_fault_test(YamlMap& map) {
  // Whatever is valid in some scenario is valid in this one, for the readers of keys.
  Scenario widest;
  widest.time_limit_s = kMaxTimeLimit_s;
  widest.coordinators = 2;
  widest.robots.emplace_back();
  (void)read_faults(map, widest, "");
  (void)read_expectations(map, widest, std::vector<PlannedFault>(kMaxFaults));
}

FaultTest load_fault_test(const std::string& path) {
  return parse_fault_test(read_yaml_file(path, kExpectedTest), path);
}

}  // namespace sidestep
