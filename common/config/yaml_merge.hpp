// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <yaml-cpp/yaml.h>

namespace sidestep {

/// Replaces each merge key "<<" below a node by the entries of the mapping, or the mappings, under it. The
/// mapping's own entries win, then those of the earlier mapping in a list (YAML 1.1, "merge key"). Merged
/// entries keep their lines. Throws ConfigError if anything else is under the key. The node must not contain
/// itself.
void apply_merge_keys(const YAML::Node& root, const std::string& file_name);

}  // namespace sidestep
