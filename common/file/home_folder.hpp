// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// A path with "~" or "~/" at its beginning replaced by the user's home folder ($HOME), as shells do.
[[nodiscard]] std::string with_home(const std::string& path);

}  // namespace sidestep
