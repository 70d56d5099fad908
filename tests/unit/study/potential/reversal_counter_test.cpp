// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/reversal_counter.hpp"

#include <numbers>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::reversal_counter_test {

constexpr double kThreshold_rad = 0.2;

/// The counter's result for a path with these headings, in steps of 1 cm.
int counted(const std::vector<double>& headings_rad) {
  ReversalCounter counter(kThreshold_rad);
  Vec2 at(0, 0);
  counter.add(at);
  for (const double heading : headings_rad) {
    at += 0.01 * rotated(Vec2(1, 0), heading);
    counter.add(at);
  }
  return counter.reversals();
}

/// The number of reversals by definition: one less than the number of turns in the longest sequence of
/// headings, in order, in which each heading differs from the previous one by more than the threshold,
/// alternately to the left and to the right.
int reversals_by_definition(const std::vector<double>& headings_rad) {
  int most = 0;
  std::vector<int> left(headings_rad.size(), 0),
      right(headings_rad.size(), 0);  // numbers of turns, by the last turn
  for (std::size_t i = 0; i < headings_rad.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double turn = headings_rad[i] - headings_rad[j];
      if (turn > kThreshold_rad) left[i] = std::max(left[i], right[j] + 1);
      if (turn < -kThreshold_rad) right[i] = std::max(right[i], left[j] + 1);
      most = std::max({most, left[i], right[i]});
    }
  return std::max(0, most - 1);
}

TEST_CASE("reversals of random paths are counted as defined") {
  int reversals = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<double> headings;
    double heading = rng.uniform(-3, 3);
    const double step = rng.uniform(0.01, 0.4);
    for (int i = 0; i < 80; ++i) headings.push_back(heading += rng.uniform(-step, step));
    const int expected = reversals_by_definition(headings);
    CHECK(counted(headings) == expected);
    reversals += expected;
  }
  CHECK(reversals > 200);
}

TEST_CASE("a wave has two reversals per period, and a circle and a straight line have none") {
  std::vector<double> wave, circle, flat;
  for (int i = 0; i < 1000; ++i) {
    wave.push_back(0.3 * std::sin(2 * std::numbers::pi * (i + 0.5) / 100));
    flat.push_back(0.05 * std::sin(2 * std::numbers::pi * i / 100));
    circle.push_back(2 * std::numbers::pi * i / 100);
  }
  CHECK(counted(wave) == 20);
  CHECK(counted(flat) == 0);
  CHECK(counted(circle) == 0);
  CHECK(counted(std::vector<double>(100, 1.5)) == 0);
}

TEST_CASE("the jitter of a robot at rest has no reversals and no length") {
  ReversalCounter counter(kThreshold_rad);
  for (int i = 0; i < 100; ++i) counter.add({1e-4 * (i % 2), 0});
  CHECK(counter.reversals() == 0);
  CHECK(counter.length_m() == 0);
}

}  // namespace sidestep::reversal_counter_test
