// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// Whether tests and programs are built with a sanitizer, which makes them several times slower and larger.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

}  // namespace sidestep
