// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <yaml-cpp/yaml.h>

namespace sidestep {

/// What a file holds. `expected` ("a scenario") stands in messages; throws ScenarioError when it cannot be
/// read.
std::string read_yaml_file(const std::string& path, const std::string& expected);

/// The one document of a YAML text; throws ScenarioError for a broken text, an empty one and several
/// documents.
YAML::Node parse_yaml(const std::string& text, const std::string& file_name, const std::string& expected);

}  // namespace sidestep
