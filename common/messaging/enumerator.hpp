// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Whether a received value is one of the type's enumerators, which count from 0 to `last`. Compares unsigned
/// numbers, because the value can be negative in some versions of Fast DDS-Gen.
template <typename Enumeration>
[[nodiscard]] constexpr bool is_enumerator(Enumeration value, Enumeration last) {
  return static_cast<std::uint32_t>(value) <= static_cast<std::uint32_t>(last);
}

}  // namespace sidestep
