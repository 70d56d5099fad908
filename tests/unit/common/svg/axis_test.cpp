// SPDX-License-Identifier: Apache-2.0
#include "common/svg/axis.hpp"

#include <cmath>
#include <limits>

#include "tests/catch.hpp"

namespace sidestep::axis_test {

TEST_CASE("steps are 1, 2 or 5 times a power of ten") {
  CHECK(round_step(0.3) == Approx(0.5));
  CHECK(round_step(0.5) == Approx(0.5));
  CHECK(round_step(0.51) == Approx(1));
  CHECK(round_step(1) == Approx(1));
  CHECK(round_step(13) == Approx(20));
  CHECK(round_step(7000) == Approx(10000));
}

TEST_CASE("marks of an axis are multiples of the step, the ends included") {
  CHECK(ticks(-1, 1, 0.5) == std::vector<double>{-1, -0.5, 0, 0.5, 1});
  CHECK(ticks(0.1, 0.4, 0.5).empty());
  CHECK(ticks(0.3, 0.9, 0.3).size() == 3);
}

TEST_CASE("an axis of any numbers has a limited number of marks, each above the one before") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity(),
                   kNan = std::numeric_limits<double>::quiet_NaN();
  CHECK(ticks(1e9, 1e9 + 1e-6, 1e-9).size() < 20);
  CHECK(ticks(0, 1e9, 1e-3).size() == 10'000);
  CHECK(ticks(0, kInfinity, 1).empty());
  CHECK(ticks(-kInfinity, 0, 1).empty());
  CHECK(ticks(0, 1, 0).empty());
  CHECK(ticks(1, 2, 0).empty());
  CHECK(ticks(0, kNan, 1).empty());
  for (const double min : {0.0, -1.0, 5e-324, kNan, 1.7e308, kInfinity}) {
    CAPTURE(min);
    CHECK(round_step(min) > 0);
    CHECK(std::isfinite(round_step(min)));
  }
}

TEST_CASE("labels have the decimals of the step, and zero has no sign") {
  CHECK(tick_label(-0.5, 0.5) == "-0.5");
  CHECK(tick_label(2, 1) == "2");
  CHECK(tick_label(-1e-17, 0.05) == "0.00");
  CHECK(tick_label(1500, 500) == "1500");
}

}  // namespace sidestep::axis_test
