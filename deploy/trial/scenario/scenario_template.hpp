// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// The text of a scenario to start from: a hall with a wall and a door, with a comment at each key. Lines
/// that begin with "#" and no space are keys that are switched off. `schema_path` is for editors; empty:
/// none.
[[nodiscard]] std::string scenario_template(const std::string& schema_path);

}  // namespace sidestep
