// SPDX-License-Identifier: Apache-2.0
#include "common/motion/escape.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {

/// By sampling, so never below the true one.
double sampled_distance_m(const Trajectory& a, const Trajectory& b, Time from) {
  const Time to = std::max({a.end(), b.end(), from}) + std::chrono::milliseconds(1);
  double smallest = 1e9;
  for (Time t = from; t <= to; t += std::chrono::milliseconds(1))
    smallest = std::min(smallest, (a.state_at(t).position_m - b.state_at(t).position_m).norm());
  return smallest;
}

}  // namespace

TEST_CASE("the rest of a trajectory is the trajectory from then on") {
  Rng rng(4);
  for (int i = 0; i < 500; ++i) {
    const Trajectory whole = random_trajectory(rng);
    const double length_s = to_seconds(whole.end() - whole.start());
    const Time from = whole.start() + from_seconds(rng.uniform(-0.2, 1.2 * length_s + 0.1));
    const Trajectory rest = rest_of(whole, from);
    CHECK(rest.start() == std::max(from, whole.start()));
    CHECK(rest.end() == std::max(whole.end(), rest.start()));
    for (int k = 0; k <= 20; ++k) {
      const Time t = rest.start() + from_seconds(k * length_s / 18);
      CHECK((rest.state_at(t).position_m - whole.state_at(t).position_m).norm() < 1e-9);
      CHECK((rest.state_at(t).velocity_mps - whole.state_at(t).velocity_mps).norm() < 1e-9);
    }
  }
}

TEST_CASE("the distance to keep is the usual one, or the base's own from then on where that is smaller") {
  Rng rng(5);
  int smaller = 0;
  for (int i = 0; i < 500; ++i) {
    const Trajectory base = random_trajectory(rng), other = random_trajectory(rng);
    const Time from = base.start() + from_seconds(rng.uniform(0, 1));
    const double keep = rng.uniform(0.1, 1.5);
    const double kept = kept_distance_m(base, from, other, keep);
    const double sampled = sampled_distance_m(base, other, std::max(from, other.start()));
    CAPTURE(i, keep, kept, sampled);
    CHECK(kept <= keep);
    CHECK(kept <= sampled);
    if (kept < keep) {
      ++smaller;
      CHECK(kept >= sampled - 0.01);  // a millisecond at ten metres a second
    }
  }
  CHECK(smaller > 50);
}
