// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Upper bound of the times that are accepted from messages and files. Sums and differences of two such times
/// fit into 64 bits.
inline constexpr std::int64_t kMaxTime_ns = std::int64_t{1} << 62;

[[nodiscard]] constexpr bool is_valid_time(std::int64_t ns) { return ns >= 0 && ns < kMaxTime_ns; }

}  // namespace sidestep
