// SPDX-License-Identifier: Apache-2.0
// Campaign trials that test the system, not the campaign.
#include "deploy/trial/simulate/campaign/scene_sampler.hpp"
#include "deploy/trial/simulate/campaign/trial.hpp"
#include "tests/catch.hpp"

namespace sidestep::campaign_test {

using namespace std::chrono_literals;

TEST_CASE("in dense scenes without faults nearly all robots keep moving") {
  int robots = 0, stationary = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Rng scene_rng = rng.fork();
    Trial trial{seed, sample_scene(scene_rng), {}, 30s};
    trial.plan.healed_at = 18s;
    const TrialResult result = run_trial(trial);
    REQUIRE(result.failures.empty());
    REQUIRE(result.excused_contacts == 0);
    REQUIRE(result.pair_s > 0);
    REQUIRE(result.excused_pair_s == 0);
    robots += result.robots;
    stationary += result.stationary;
  }
  // Robots that evade each other to the right along a wall may block each other permanently.
  CAPTURE(robots, stationary);
  CHECK(stationary * 50 <= robots);
}

}  // namespace sidestep::campaign_test
