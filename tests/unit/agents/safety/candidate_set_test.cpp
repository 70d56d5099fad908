// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/candidate_set.hpp"

#include <algorithm>

#include "agents/safety/safety_search.hpp"
#include "common/motion/clearance.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::candidate_set_test {

const Time kStart = time_from_ns(5'000'000'000);
constexpr Duration kHold{33'333'334};
constexpr double kSpan_s = 0.6;

TEST_CASE(
    "on every instruction set, candidates count as excluded or certainly clear only if the exact clearance "
    "agrees") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const MotionLimits limits;
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    CAPTURE(kernels.name, seed);
    Rng rng(seed);
    CandidateSet candidates(48, limits, kernels);
    batch::BatchClearance clearance(kernels);
    int excluded = 0, certainly_clear = 0;
    for (int round = 0; round < 500; ++round) {
      CAPTURE(round);
      const State at_start{{0, 0}, random_velocity(rng, 2, 3)};
      candidates.sample_accelerations(at_start.velocity_mps, {0, 0}, kHold, limits.speed_mps, rng);
      const auto motion = [&](std::size_t i) {
        return accelerate_then_stop(kStart, at_start, candidates.acceleration(i), kHold,
                                    limits.deceleration_mps2);
      };
      std::vector<Trajectory> others;
      std::vector<double> separations;
      clearance.reset(kStart);
      for (int i = 0; i < 3; ++i) {
        others.push_back(random_trajectory(rng, kStart));
        // Half of the separations are close to the distance that a candidate keeps, where rounding decides.
        const double distance = clearance_m(motion(rng.below(candidates.size())), others.back(), 0);
        separations.push_back(rng.chance(0.5) ? 0.19 : distance + rng.uniform(-1e-8, 1e-8));
        clearance.add(trajectory_bounds(others.back()), separations.back());
      }
      clearance.sample(kStart, kSpan_s);
      candidates.sample_motions(at_start, to_seconds(kHold), clearance.step_s());
      const auto is_compared = [&](std::size_t lane) { return !clearance.needs_exact(lane); };
      for (std::size_t lane = 0; lane < others.size(); ++lane) {
        if (!is_compared(lane)) continue;
        candidates.compare(clearance.track(lane), clearance.start_s(lane), clearance.min_separation_m(lane),
                           clearance.acceleration_mps2(lane));
      }
      std::vector<bool> is_left(candidates.size());
      while (const auto index = candidates.take_nearest(0)) is_left[*index] = true;
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        CAPTURE(i);
        const Trajectory candidate = motion(i);
        bool is_exactly_clear = true;
        for (std::size_t lane = 0; lane < others.size(); ++lane) {
          if (is_compared(lane))
            is_exactly_clear = is_exactly_clear && is_clear(candidate, others[lane], separations[lane]);
        }
        if (candidates.is_certainly_clear(i)) REQUIRE(is_exactly_clear);
        if (!is_left[i]) REQUIRE_FALSE(is_exactly_clear);
        excluded += !is_left[i];
        certainly_clear += candidates.is_certainly_clear(i);
      }
    }
    CHECK(excluded > 1000);
    CHECK(certainly_clear > 1000);
  }
}

}  // namespace sidestep::candidate_set_test
