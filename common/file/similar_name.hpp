// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sidestep {

/// The names that a mistyped name most likely stands for: those of which it is the beginning, or else those
/// with the fewest wrong, missing, surplus and swapped letters, which may be one in three. Ignores case. At
/// most three names, in their order.
[[nodiscard]] std::vector<std::string> similar_names(std::string_view text,
                                                     std::span<const std::string> names);

/// "; did you mean A or B?"; empty if no name is similar.
[[nodiscard]] std::string did_you_mean(std::string_view text, std::span<const std::string> names);

}  // namespace sidestep
