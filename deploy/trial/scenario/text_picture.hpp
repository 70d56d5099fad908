// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"

namespace sidestep {

/// The narrowest picture that still shows something.
inline constexpr int kMinPictureColumns = 20;

/// Draws the floor of a scenario with characters, for terminals: at most `columns` wide, with a legend of
/// what occurs in it and the scale.
[[nodiscard]] std::string text_picture(const Scenario& scenario, int columns);

}  // namespace sidestep
