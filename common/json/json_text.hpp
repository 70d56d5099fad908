// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace sidestep {

// nlohmann's own functions would be compiled again in each source file that calls them, which takes seconds.

/// The text of a value: on one line, or indented by `indent` spaces per level. Bytes that are not UTF-8
/// become U+FFFD.
[[nodiscard]] std::string json_text(const nlohmann::json& json, int indent = -1);
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

/// Throws nlohmann::json::parse_error if the text is not JSON, or returns a discarded value if
/// `throws_errors` is false. Text that nests more than 100 levels deep counts as no JSON, because nlohmann's
/// functions call themselves for each level. So does ordered text with an object of more than 10,000 keys,
/// because nlohmann compares each key with all earlier ones.
[[nodiscard]] nlohmann::json parse_json(std::string_view text, bool throws_errors = true);
[[nodiscard]] nlohmann::ordered_json parse_ordered_json(std::string_view text, bool throws_errors = true);

}  // namespace sidestep
