// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// The name of this host; empty if it has none.
[[nodiscard]] std::string host_name();

}  // namespace sidestep
