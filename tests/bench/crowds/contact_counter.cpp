// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/contact_counter.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kSample_s = 0.001;
constexpr double kApart_m = 0.001;  ///< clearance from which a pair no longer touches

/// The largest distance from the start during the cycle.
double reach_m(const CycleMotion& robot, double cycle_s) {
  return cycle_s * (robot.at_start.velocity_mps.norm() + cycle_s * robot.acceleration_mps2.norm() / 2);
}

}  // namespace

void ContactCounter::add(std::span<const CycleMotion> robots, double cycle_s) {
  const auto samples = static_cast<int>(std::ceil(cycle_s / kSample_s - 1e-9));
  const auto position_m = [&](std::size_t robot, double elapsed_s) {
    return state_after(robots[robot].at_start, robots[robot].acceleration_mps2, elapsed_s).position_m;
  };
  // `approach_m` is an upper bound of the decrease of the clearance during the cycle.
  const auto examine = [&](const Pair& pair, double approach_m, auto clearance_m) {
    if (clearance_m(0.0) - approach_m > kApart_m) {
      touching_.erase(pair);
      return;
    }
    for (int k = 1; k <= samples; ++k) check(pair, clearance_m(cycle_s * k / samples));
  };
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const double reach_here_m = reach_m(robots[i], cycle_s);
    for (std::size_t j = i + 1; j < robots.size(); ++j)
      examine({i, j}, reach_here_m + reach_m(robots[j], cycle_s), [&](double elapsed_s) {
        return (position_m(i, elapsed_s) - position_m(j, elapsed_s)).norm() - 2 * radius_m_;
      });
    for (std::size_t k = 0; k < obstacles_.size(); ++k)
      examine({i, robots.size() + k}, reach_here_m, [&](double elapsed_s) {
        return signed_distance(position_m(i, elapsed_s), obstacles_[k]) - radius_m_;
      });
  }
}

void ContactCounter::check(const Pair& pair, double clearance_m) {
  if (clearance_m < 0) {
    if (touching_.insert(pair).second) ++contacts_;
  } else if (clearance_m > kApart_m) {
    touching_.erase(pair);
  }
}

}  // namespace sidestep
