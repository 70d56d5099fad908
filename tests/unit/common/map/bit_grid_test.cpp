// SPDX-License-Identifier: Apache-2.0
#include "common/map/bit_grid.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::bit_grid_test {

TEST_CASE("runs of bits are found as if by checking each bit") {
  const std::uint64_t seed = GENERATE(range(1, 60));
  CAPTURE(seed);
  Rng rng(seed);
  const int columns = 1 + static_cast<int>(rng.below(200));
  const double set_part = rng.chance(0.5) ? 0.5 : rng.chance(0.5) ? 0.01 : 0.99;
  const BitGrid bits = test::noise(rng, columns, 3, set_part);
  const auto below = [&](int count) {
    return static_cast<int>(rng.below(static_cast<std::uint64_t>(count)));
  };
  for (int i = 0; i < 300; ++i) {
    const int row = below(3), begin = below(columns + 1), end = begin + below(columns - begin + 1);
    CAPTURE(columns, row, begin, end);
    int first_set = begin, first_clear = begin;
    while (first_set < end && !bits.get(first_set, row)) ++first_set;
    while (first_clear < end && bits.get(first_clear, row)) ++first_clear;
    CHECK(bits.find_set(begin, end, row) == first_set);
    CHECK(bits.find_clear(begin, end, row) == first_clear);
    const int from = below(columns), last = below(from + 1);
    int down = from;
    while (down >= last && !bits.get(down, row)) --down;
    CAPTURE(from, last);
    CHECK(bits.find_last_set(from, last, row) == down);
  }
}

TEST_CASE("setting or clearing a run of bits does not affect its neighbours") {
  for (const int begin : {0, 1, 63, 64, 65}) {
    for (const int end : {begin, begin + 1, 64, 65, 128, 130}) {
      CAPTURE(begin, end);
      BitGrid bits(130, 2), holes(130, 2);
      holes.set_run(0, 130, 0);
      bits.set_run(begin, end, 0);
      holes.set_run(begin, end, 0, false);
      for (int column = 0; column < 130; ++column) {
        const bool is_inside = column >= begin && column < end;
        CHECK(bits.get(column, 0) == is_inside);
        CHECK(holes.get(column, 0) != is_inside);
        CHECK_FALSE(bits.get(column, 1));
      }
    }
  }
}

TEST_CASE("a grid without cells is rejected") {
  CHECK_THROWS_AS(BitGrid(0, 1), std::invalid_argument);
  CHECK_THROWS_AS(BitGrid(1, -1), std::invalid_argument);
}

}  // namespace sidestep::bit_grid_test
