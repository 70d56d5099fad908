// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// Why a user-supplied heading in radians is rejected: it is not finite, or its magnitude exceeds a full
/// turn, which suggests degrees. Empty if it is valid.
[[nodiscard]] std::string heading_problem(double heading_rad);

}  // namespace sidestep
