// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// Exit codes of all programs. Success is 0.
inline constexpr int kExitFailure = 1;  ///< failure at run time
inline constexpr int kExitUsage = 2;    ///< wrong usage or an invalid scenario

}  // namespace sidestep
