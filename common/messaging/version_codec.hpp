// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/coordinate_bound.hpp"
#include "common/motion/version.hpp"
#include "idl/trajectory.hpp"

namespace sidestep {

/// Codecs refuse larger speeds: no robot is that fast.
inline constexpr double kMaxSpeed_mps = 100;
/// Codecs refuse versions with larger accelerations along an axis.
inline constexpr double kMaxAcceleration_mps2 = 1000;

/// Decodes an untrusted version. Returns nullopt unless all numbers are finite and physically plausible,
/// times and durations within bounds, and phase count and robot id in range.
[[nodiscard]] std::optional<Version> decode(const msg::Version& message);
/// Decodes an untrusted version with the same checks. Also returns nullopt if its numbers or start are
/// implausible (is_plausible()) at `now`, by the local clock.
[[nodiscard]] std::optional<Version> decode(const msg::Version& message, Time now);

msg::Version encode(const Version& version);

}  // namespace sidestep
