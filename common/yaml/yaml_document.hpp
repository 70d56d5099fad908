// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <yaml-cpp/yaml.h>

namespace sidestep {

/// The content of a YAML file. `expected` ("a scenario") appears in error messages. Throws ConfigError if the
/// file cannot be read.
[[nodiscard]] std::string read_yaml_file(const std::string& path, const std::string& expected);

/// The single document of a YAML text, with its merge keys ("<<") applied. Throws ConfigError if the text is
/// empty, malformed, nested too deeply, contains several documents or an alias inside its own anchor, or has
/// more than 400,000 values, counting those of aliases.
[[nodiscard]] YAML::Node parse_yaml(const std::string& text, const std::string& file_name,
                                    const std::string& expected);

}  // namespace sidestep
