// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <yaml-cpp/yaml.h>

namespace sidestep {

/// Replaces each merge key "<<" below a node by the entries of the mapping or mappings under it. The node's
/// own entries take precedence over merged entries, and earlier mappings over later ones (YAML 1.1, "merge
/// key"). Merged entries keep their line numbers. Throws ConfigError if the value of the key is anything
/// else. Precondition: the node does not contain itself.
void apply_merge_keys(const YAML::Node& root, const std::string& file_name);

}  // namespace sidestep
