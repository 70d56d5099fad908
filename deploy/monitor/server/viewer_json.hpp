// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace sidestep {

/// Nothing that viewers have to say is nested more deeply.
inline constexpr int kMaxViewerJsonDepth = 16;

/// The JSON that a viewer has sent; Json::value_t::discarded if it is none, or nested more deeply than
/// kMaxViewerJsonDepth. Copying or printing a value of the library recurses: 64 kB of brackets would take
/// most of a stack, and all of it in builds with sanitizers.
[[nodiscard]] nlohmann::json parse_viewer_json(const std::string& text);

}  // namespace sidestep
