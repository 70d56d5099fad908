// SPDX-License-Identifier: Apache-2.0
// Trials of the seeded search that say something about the system rather than about the search.
#include <catch2/catch.hpp>

#include "deploy/simulate/campaign/scene_sampler.hpp"
#include "deploy/simulate/campaign/trial.hpp"

using namespace sidestep;
using namespace std::chrono_literals;

TEST_CASE("on crowded floors on which nothing goes wrong nearly everybody keeps moving") {
  int robots = 0, idle = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Rng for_scene = rng.fork();
    Trial trial{seed, sample_scene(for_scene), {}, 30s};
    trial.plan.healed_at = 18s;
    const TrialResult result = run_trial(trial);
    REQUIRE(result.failures.empty());
    robots += result.robots;
    idle += result.idle;
  }
  // Where robots are pressed against a wall and turn to the right of each other, they all stay there.
  CAPTURE(robots, idle);
  CHECK(idle * 50 <= robots);
}
