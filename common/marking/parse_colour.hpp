// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/marking/colours.hpp"
#include "common/yaml/yaml_map.hpp"

namespace sidestep {

/// Parses a colour name. Throws ConfigError for `location` if there is no such colour.
[[nodiscard]] Colour parse_colour(const YAML::Node& node, const YamlLocation& location);

}  // namespace sidestep
