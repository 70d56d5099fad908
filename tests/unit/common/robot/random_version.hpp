// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/version.hpp"
#include "common/random/rng.hpp"

namespace sidestep::test {

/// A version that begins anywhere on a floor of 12 m x 12 m at up to 2 m/s, with up to three phases and a
/// stop, and sometimes an intent.
inline Version random_version(RobotId robot, VersionNumber number, Rng& rng) {
  const auto vec = [&rng](double bound) {
    return Vec2(rng.uniform(-bound, bound), rng.uniform(-bound, bound));
  };
  Version version;
  version.robot = robot;
  version.incarnation = 100;
  version.number = number;
  version.base = number - 1;
  const auto start = static_cast<std::int64_t>(rng.uniform(0.0, 1e9));
  version.trajectory = Trajectory(time_from_ns(1'700'000'000'000'000'000 + start), {vec(6), vec(1.4)});
  const auto phases = static_cast<int>(rng.uniform(0.0, 3.99));
  for (int i = 0; i < phases; ++i)
    version.trajectory.append(Duration{static_cast<std::int64_t>(rng.uniform(0.0, 5e8))}, vec(3));
  append_stop(version.trajectory, 5);
  version.inflation_m = rng.chance(0.5) ? rng.uniform(0.0, 0.1) : 0;
  // Intents are floats in messages.
  const auto rounded = [&](double bound) { return Vec2(vec(bound).cast<float>().cast<double>()); };
  if (rng.chance(0.5))
    version.intent = {rounded(2), static_cast<float>(rng.uniform(0.0, 1.0)), rounded(6), rounded(6),
                      rounded(6)};
  return version;
}

}  // namespace sidestep::test
