// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace sidestep {

/// Maximum nesting; no valid message of a viewer is nested more deeply.
inline constexpr int kMaxViewerJsonDepth = 16;

/// Parses the JSON that a viewer has sent. Returns Json::value_t::discarded if it is not JSON, or is nested
/// more deeply than kMaxViewerJsonDepth. The library copies and prints values recursively: 64 kB of brackets
/// would take most of a stack, and all of it in builds with sanitizers.
[[nodiscard]] nlohmann::json parse_viewer_json(const std::string& text);

}  // namespace sidestep
