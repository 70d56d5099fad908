// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// Replaces a leading "~" or "~/" in a path with the user's home folder ($HOME), as shells do.
[[nodiscard]] std::string expand_home(const std::string& path);

}  // namespace sidestep
