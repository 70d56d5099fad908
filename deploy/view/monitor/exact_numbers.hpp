// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

namespace sidestep {

/// JavaScript holds numbers as doubles, so it rounds whole numbers beyond this one.
inline constexpr std::int64_t kMaxExactNumber = (std::int64_t{1} << 53) - 1;

/// Replaces each whole number beyond kMaxExactNumber, for example an epoch or an incarnation, by its digits
/// as text. Without this, pages would show other numbers than logs and terminals do.
void make_numbers_exact(nlohmann::ordered_json& json);

}  // namespace sidestep
