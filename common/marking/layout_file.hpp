// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/marking/layout.hpp"

namespace sidestep {

/// Reads and checks a layout's file (deploy/scenarios/markings/butterfly.yaml is one); throws ScenarioError
/// ("FILE:LINE:
/// ...") for anything that is wrong.
MarkingLayout load_layout(const std::string& path);
/// The same from text; `file_name` stands in messages.
MarkingLayout parse_layout(const std::string& text, const std::string& file_name);

}  // namespace sidestep
