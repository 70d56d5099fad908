// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/batch_clearance.hpp"

#include <algorithm>

#include "agents/batch/dispatch.hpp"
#include "common/motion/clearance.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::batch_clearance_test {

const Time kBegin = time_from_ns(1'000'000'000);

/// A typical proposed version, which starts at about the same time as the others.
Trajectory typical_trajectory(Rng& rng) {
  const Vec2 position = random_vector(rng, 0.6), velocity = random_velocity(rng, 2, 3.2);
  Trajectory trajectory(kBegin + from_seconds(rng.uniform(-0.03, 0.03)), {position, velocity});
  const Vec2 acceleration = random_vector(rng, 3);
  trajectory.append(from_seconds(rng.uniform(0.001, 0.1)), acceleration);
  append_stop(trajectory, 5);
  return trajectory;
}

/// Difficult cases: empty phases; starts that are equal, seconds or hours apart; robots at rest; phases that
/// end together; more phases than a lane has; and numbers that only a hostile sender would use.
Trajectory difficult_trajectory(Rng& rng) {
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
  // Without its stop, the trajectory comes to rest instantly from any speed.
  if (!rng.chance(0.1)) append_stop(trajectory, 5);
  return trajectory;
}

/// Compares one trajectory with many as the safety search does: by lanes, and by is_clear() where the lanes
/// are undecided.
class BatchedClearance {
 public:
  explicit BatchedClearance(const batch::Kernels& kernels) : clearance_(kernels) {}

  void restart(Time base) {
    clearance_.reset(base);
    others_.clear();
  }
  void add(const Trajectory& other, double min_separation_m) {
    clearance_.add(trajectory_bounds(other), min_separation_m);
    others_.push_back({other, min_separation_m});
  }
  std::vector<bool> compare(const Trajectory& one) {
    std::vector<bool> clear;
    const bool is_batched = sample_and_compare(one, 0);
    for (std::size_t lane = 0; lane < others_.size(); ++lane) {
      const bool is_decided = is_batched && !clearance_.needs_exact(lane) &&
                              (clearance_.is_clear(lane) || clearance_.is_blocked(lane));
      ++(is_decided ? decided_ : undecided_);
      clear.push_back(is_decided ? clearance_.is_clear(lane) : is_exactly_clear(one, lane, 0));
    }
    return clear;
  }
  /// With extra clearance, lanes must be conservative in both directions.
  void check_extra_clearance(const Trajectory& one, double extra_m) {
    if (!sample_and_compare(one, extra_m)) return;
    for (std::size_t lane = 0; lane < others_.size(); ++lane) {
      if (clearance_.needs_exact(lane)) continue;
      if (clearance_.is_clear(lane) && !is_exactly_clear(one, lane, extra_m))
        FAIL("lane " << lane << " is falsely clear with extra clearance " << extra_m);
      if (clearance_.is_blocked(lane) && is_exactly_clear(one, lane, -extra_m))
        FAIL("lane " << lane << " is falsely blocked with extra clearance " << extra_m);
    }
  }

  std::uint64_t decided() const { return decided_; }
  std::uint64_t undecided() const { return undecided_; }

 private:
  struct Other {
    Trajectory trajectory;
    double min_separation_m;
  };
  bool sample_and_compare(const Trajectory& one, double extra_m) {
    const TrajectoryBounds bounds = trajectory_bounds(one);
    const double seconds = bounds.first_s + bounds.second_s;
    if (!bounds.is_batchable || seconds > batch::kMaxHorizon_s) return false;
    clearance_.sample(one.start(), seconds);
    clearance_.compare(batch::track_of(bounds, one.start(), clearance_.step_s()), bounds.acceleration_mps2,
                       extra_m);
    return true;
  }
  bool is_exactly_clear(const Trajectory& one, std::size_t lane, double extra_m) const {
    return is_clear(one, others_[lane].trajectory, others_[lane].min_separation_m + extra_m);
  }

  batch::BatchClearance clearance_;
  std::vector<Other> others_;  // parallel to clearance_
  std::uint64_t decided_ = 0, undecided_ = 0;
};

using Generator = Trajectory (*)(Rng&);

/// Compares random trajectories. A fifth of the minimum separations are close to the pair's true distance,
/// where rounding decides.
void check_random_pairs(BatchedClearance& batch, Generator generate, std::uint64_t seed, int rounds) {
  Rng rng(seed);
  for (int round = 0; round < rounds; ++round) {
    CAPTURE(round);
    const Trajectory one = generate(rng);
    const std::size_t count = rng.below(40);
    std::vector<Trajectory> others;
    std::vector<double> separations;
    for (std::size_t i = 0; i < count; ++i) {
      others.push_back(generate(rng));
      const double distance = clearance_m(one, others.back(), 0);
      separations.push_back(!rng.chance(0.2)  ? 0.19
                            : rng.chance(0.3) ? distance
                            : rng.chance(0.5) ? distance + rng.uniform(-1e-8, 1e-8)
                                              : distance + rng.uniform(-1e-3, 1e-3));
    }
    batch.restart(rng.chance(0.9) ? one.start() : kBegin);
    for (std::size_t i = 0; i < count; ++i) batch.add(others[i], separations[i]);
    // The second trajectory may start at the same time as the first one. The third one equals the first one,
    // so that its sampling is either reused or repeated.
    for (const Trajectory& tested : {one, generate(rng), one}) {
      const auto clear = batch.compare(tested);
      REQUIRE(clear.size() == count);
      for (std::size_t i = 0; i < count; ++i) {
        if (clear[i] != is_clear(tested, others[i], separations[i]))
          FAIL("wrong result for trajectory " << i << " at minimum separation " << separations[i]);
      }
    }
    if (round % 4 == 0) batch.check_extra_clearance(one, rng.uniform(0, 0.3));
  }
}

TEST_CASE("lanes agree with the exact clearance over millions of pairs, on every instruction set") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    CAPTURE(kernels.name, seed);
    BatchedClearance random_pairs(kernels), difficult_pairs(kernels);
    check_random_pairs(
        random_pairs, [](Rng& rng) { return random_trajectory(rng, kBegin); }, seed, 10'000);
    check_random_pairs(difficult_pairs, difficult_trajectory, seed, 10'000);
    CAPTURE(random_pairs.decided(), random_pairs.undecided());
    CAPTURE(difficult_pairs.decided(), difficult_pairs.undecided());
    CHECK(random_pairs.decided() + random_pairs.undecided() > 500'000);
    CHECK(difficult_pairs.decided() + difficult_pairs.undecided() > 500'000);
    CHECK(random_pairs.decided() > 100'000);
    CHECK(difficult_pairs.decided() > 75'000);
  }
}

TEST_CASE("few of the pairs that agents compare need the exact clearance") {
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    Rng rng(7);
    BatchedClearance batch(kernels);
    for (int round = 0; round < 2000; ++round) {
      std::vector<Trajectory> others;
      for (int i = 0; i < 32; ++i) others.push_back(typical_trajectory(rng));
      batch.restart(kBegin);
      for (const Trajectory& other : others) batch.add(other, 0.19);
      const Trajectory one = typical_trajectory(rng);
      const auto clear = batch.compare(one);
      for (std::size_t i = 0; i < others.size(); ++i) REQUIRE(clear[i] == is_clear(one, others[i], 0.19));
    }
    CAPTURE(kernels.name, batch.decided(), batch.undecided());
    CHECK(batch.undecided() * 20 < batch.decided() + batch.undecided());
  }
}

TEST_CASE("resetting a batch removes everything that was added") {
  BatchedClearance batch(batch::best_kernels());
  batch.restart(kBegin);
  const Trajectory one = Trajectory::resting(kBegin, {0, 0}), other = Trajectory::resting(kBegin, {1, 0});
  CHECK(batch.compare(one).empty());
  batch.add(other, 0.5);
  batch.add(other, 1.5);
  CHECK(batch.compare(one) == std::vector<bool>{true, false});
  CHECK(batch.decided() == 2);
  batch.restart(kBegin);
  CHECK(batch.compare(one).empty());
}

TEST_CASE("all lanes are clear only if each of them is clear without an exact comparison") {
  batch::BatchClearance clearance(batch::best_kernels());
  const Trajectory one = Trajectory::resting(kBegin, {0, 0}), other = Trajectory::resting(kBegin, {1, 0});
  const auto compare = [&] {
    clearance.sample(kBegin, 0.5);
    clearance.compare(batch::track_of(trajectory_bounds(one), kBegin, clearance.step_s()), 0, 0);
    return clearance.are_all_clear();
  };
  clearance.reset(kBegin);
  for (int i = 0; i < 9; ++i) clearance.add(trajectory_bounds(other), 0.5);
  CHECK(compare());
  clearance.add(trajectory_bounds(other), 1.5);
  CHECK_FALSE(compare());
  clearance.reset(kBegin);
  clearance.add(trajectory_bounds(other), 0.5);
  Trajectory long_motion(kBegin, {{5, 0}, {1, 0}});
  long_motion.append(std::chrono::seconds(2), {0, 0});
  append_stop(long_motion, 5);
  clearance.add(trajectory_bounds(long_motion), 0.5);
  CHECK_FALSE(compare());
}

}  // namespace sidestep::batch_clearance_test
