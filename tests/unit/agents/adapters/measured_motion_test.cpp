// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/measured_motion.hpp"

#include "tests/catch.hpp"

namespace sidestep::measured_motion_test {

using namespace std::chrono_literals;

TEST_CASE("a base's velocity follows from its odometry in any frame") {
  const Time begin = time_from_ns(1'000'000'000'000);
  const double frame_rad = 2.1;
  MeasuredMotion measured;
  CHECK(measured.until() == Time{});
  // Forward at 0.5 m/s and left at 0.2 m/s, without turning.
  for (int i = 0; i <= 10; ++i) {
    const double s = 0.02 * i;
    measured.add({3, begin + i * 20ms, rotated(Vec2(0.5 * s, 0.2 * s), frame_rad) + Vec2(7, 8), frame_rad});
  }
  CHECK(measured.until() == begin + 200ms);
  const auto velocity = measured.mean(begin + 55ms, begin + 65ms);
  REQUIRE(velocity);
  CHECK(velocity->linear_mps.x() == Approx(0.5));
  CHECK(velocity->linear_mps.y() == Approx(0.2));
  CHECK(velocity->turn_radps == Approx(0).margin(1e-9));
  CHECK_FALSE(measured.mean(begin + 195ms, begin + 205ms));
  CHECK_FALSE(measured.mean(begin - 5ms, begin + 5ms));
}

TEST_CASE("a turning base moves in the direction of its heading at the middle of the interval") {
  const Time begin = time_from_ns(1'000'000'000'000);
  const double turn_radps = GENERATE(-2.5, 2.5);
  MeasuredMotion measured;
  Vec2 position_m(3, 4);
  double heading_rad = 0.7;
  for (int ms = 0; ms <= 200; ++ms) {
    if (ms % 20 == 0) measured.add({3, begin + ms * 1ms, position_m, heading_rad});
    position_m += 0.001 * rotated(Vec2(0.5, 0.2), heading_rad + 0.0005 * turn_radps);
    heading_rad += 0.001 * turn_radps;
  }
  const auto velocity = measured.mean(begin + 100ms, begin + 120ms);
  REQUIRE(velocity);
  CHECK(velocity->linear_mps.x() == Approx(0.5).margin(0.001));
  CHECK(velocity->linear_mps.y() == Approx(0.2).margin(0.001));
  CHECK(velocity->turn_radps == Approx(turn_radps));
}

TEST_CASE("late odometry reports and reports after a long gap give no velocity") {
  const Time begin = time_from_ns(1'000'000'000'000);
  MeasuredMotion measured;
  measured.add({3, begin, {0, 0}, 0});
  measured.add({3, begin - 10ms, {5, 0}, 0});
  CHECK(measured.until() == begin);
  measured.add({3, begin + 2s, {1, 0}, 0});
  CHECK_FALSE(measured.mean(begin + 1s, begin + 1010ms));
  measured.add({3, begin + 2020ms, {1.02, 0}, 3.1});
  measured.add({3, begin + 2040ms, {1.02, 0}, -3.1});
  REQUIRE(measured.mean(begin + 2022ms, begin + 2038ms));
  CHECK(measured.mean(begin + 2022ms, begin + 2038ms)->turn_radps == Approx((2 * 3.14159265 - 6.2) / 0.02));
}

}  // namespace sidestep::measured_motion_test
