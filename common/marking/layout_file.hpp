// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/marking/layout.hpp"

namespace sidestep {

/// Reads and checks a marker layout file such as deploy/scenarios/markings/butterfly.yaml. Throws
/// ConfigError.
[[nodiscard]] MarkerLayout load_layout(const std::string& path);
/// Parses and checks the text of a marker layout file; `file_name` appears in error messages.
[[nodiscard]] MarkerLayout parse_layout(const std::string& text, const std::string& file_name);

}  // namespace sidestep
