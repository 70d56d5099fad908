// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/clearance_batch.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/motion/clearance.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {

const Time kBegin = time_from_ns(1'000'000'000);

/// A version as agents make them, starting about when the others do.
Trajectory usual(Rng& rng) {
  Trajectory trajectory(
      kBegin + from_seconds(rng.uniform(-0.03, 0.03)),
      {random_vector(rng, 0.6), rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3.2, 3.2))});
  trajectory.append(from_seconds(rng.uniform(0.001, 0.1)), random_vector(rng, 3));
  append_stop(trajectory, 5);
  return trajectory;
}

/// What makes trouble: empty phases, starts that are equal, whole seconds away or for ever ago, standing
/// robots, phases that end together, more phases than fit, numbers that nobody would send but an enemy.
Trajectory nasty(Rng& rng) {
  const Time start = rng.chance(0.3)   ? kBegin
                     : rng.chance(0.3) ? time_from_ns(0)
                     : rng.chance(0.3) ? kBegin + std::chrono::hours(1)
                                       : kBegin + from_seconds(rng.uniform(-0.5, 1.5));
  const Vec2 velocity = rng.chance(0.3)    ? Vec2(0, 0)
                        : rng.chance(0.05) ? random_vector(rng, 100)
                                           : random_vector(rng, 2);
  Trajectory trajectory(start, {random_vector(rng, rng.chance(0.05) ? 1e4 : 0.5), velocity});
  const auto phases = rng.below(4);
  for (std::uint64_t i = 0; i < phases; ++i) {
    const Duration duration = rng.chance(0.3)   ? Duration{static_cast<std::int64_t>(rng.below(3))}
                              : rng.chance(0.1) ? std::chrono::minutes(1)
                              : rng.chance(0.3) ? Duration{16'666'667}
                                                : from_seconds(rng.uniform(0, 0.4));
    const Vec2 acceleration = rng.chance(0.05) ? random_vector(rng, 1000) : random_vector(rng, 5);
    trajectory.append(duration, rng.chance(0.2) ? Vec2(0, 0) : acceleration);
  }
  // Without it the robot stands at once at the end, however fast it was.
  if (!rng.chance(0.1)) append_stop(trajectory, 5);
  return trajectory;
}

using Maker = Trajectory (*)(Rng&);

/// Compares each with all the rest, at distances to keep about what each pair has: there rounding decides.
void compare(const batch::Kernels& kernels, Maker maker, std::uint64_t seed, int rounds, std::uint64_t& pairs,
             std::uint64_t& left_to_exact) {
  CAPTURE(kernels.name, seed);
  Rng rng(seed);
  ClearanceBatch batch(kernels);
  for (int round = 0; round < rounds; ++round) {
    CAPTURE(round);
    const Trajectory one = maker(rng);
    const std::size_t count = rng.below(40);
    std::vector<Trajectory> others;
    std::vector<TrajectoryBounds> outlines;
    std::vector<double> keep;
    for (std::size_t i = 0; i < count; ++i) {
      others.push_back(maker(rng));
      outlines.push_back(trajectory_bounds(others.back()));
      const double touching = clearance_m(one, others.back(), 0);
      keep.push_back(!rng.chance(0.2)  ? 0.19
                     : rng.chance(0.3) ? touching
                     : rng.chance(0.5) ? touching + rng.uniform(-1e-8, 1e-8)
                                       : touching + rng.uniform(-1e-3, 1e-3));
    }
    batch.restart(rng.chance(0.9) ? one.start() : kBegin);
    for (std::size_t i = 0; i < count; ++i) batch.add(outlines[i], others[i], keep[i]);
    // The second one may begin when the first one did, or not.
    for (const Trajectory& tried : {one, maker(rng), one}) {
      const auto clear = batch.compare(tried);
      REQUIRE(clear.size() == count);
      for (std::size_t i = 0; i < count; ++i) {
        if ((clear[i] != 0) != is_clear(tried, others[i], keep[i]))
          FAIL("other " << i << ", keep " << keep[i]);
      }
      pairs += count;
    }
  }
  left_to_exact += batch.left_to_exact();
}

}  // namespace

TEST_CASE(
    "a batch decides as the exact clearance does, over millions of pairs and on every instruction set") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    std::uint64_t pairs = 0, left_to_exact = 0;
    compare(
        kernels, [](Rng& rng) { return random_trajectory(rng, kBegin); }, seed, 10'000, pairs, left_to_exact);
    compare(kernels, nasty, seed, 10'000, pairs, left_to_exact);
    CHECK(pairs > 1'000'000);
  }
}

TEST_CASE("of the pairs that agents and coordinators compare, a batch leaves few to the exact clearance") {
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    Rng rng(7);
    ClearanceBatch batch(kernels);
    std::uint64_t pairs = 0;
    for (int round = 0; round < 2000; ++round) {
      std::vector<Trajectory> others;
      std::vector<TrajectoryBounds> outlines;
      for (int i = 0; i < 32; ++i) {
        others.push_back(usual(rng));
        outlines.push_back(trajectory_bounds(others.back()));
      }
      batch.restart(kBegin);
      for (std::size_t i = 0; i < others.size(); ++i) batch.add(outlines[i], others[i], 0.19);
      const Trajectory one = usual(rng);
      const auto clear = batch.compare(one);
      for (std::size_t i = 0; i < others.size(); ++i)
        REQUIRE((clear[i] != 0) == is_clear(one, others[i], 0.19));
      pairs += others.size();
    }
    CAPTURE(kernels.name, pairs, batch.left_to_exact());
    CHECK(batch.left_to_exact() * 20 < pairs);
  }
}

TEST_CASE("an empty batch has nothing to say, and one that was cleared has forgotten") {
  ClearanceBatch batch;
  batch.restart(kBegin);
  const Trajectory here = Trajectory::resting(kBegin, {0, 0}), there = Trajectory::resting(kBegin, {1, 0});
  CHECK(batch.compare(here).empty());
  const TrajectoryBounds outline = trajectory_bounds(there);
  batch.add(outline, there, 0.5);
  batch.add(outline, there, 1.5);
  const auto clear = batch.compare(here);
  REQUIRE(clear.size() == 2);
  CHECK(clear[0] == 1);
  CHECK(clear[1] == 0);
  batch.restart(kBegin);
  CHECK(batch.compare(here).empty());
}
