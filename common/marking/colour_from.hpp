// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/yaml_map.hpp"
#include "common/marking/colours.hpp"

namespace sidestep {

/// The colour that a file names, or a refusal.
Colour colour_from(const YAML::Node& node, const YamlPlace& place);

}  // namespace sidestep
