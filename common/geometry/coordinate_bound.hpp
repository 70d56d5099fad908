// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// Largest coordinate of a position that is accepted from another process. Every check of received positions
/// uses it, so that no process refuses a place that others accept. No floor is that large: scenarios allow
/// 1000 m.
inline constexpr double kMaxCoordinate_m = 1e4;

}  // namespace sidestep
