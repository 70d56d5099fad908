// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>

#include "tests/catch.hpp"
#include "tests/unit/simulator/world/random_drive.hpp"

namespace sidestep::tracking_test {

using test::RandomDrive;
using test::separated_robots;

struct ErrorQuantiles {
  double median_mm, p99_mm, max_mm, top_speed_mps;
};

// Quantiles of the bodies' distances from their references over all steps.
ErrorQuantiles measure_tracking(const Scenario& scenario, double seconds, std::uint64_t seed) {
  const Time begin = time_from_ns(1'700'000'000'000'000'000);
  World world(scenario, begin, seed);
  std::vector<RandomDrive> drives;
  for (std::size_t i = 0; i < world.robot_count(); ++i)
    drives.emplace_back(scenario, world, i, 1000 * seed + i);
  std::vector<float> errors_mm;
  double top_speed = 0;
  for (Time t = begin; t < begin + from_seconds(seconds); t += kPhysicsStep) {
    world.advance(t);
    for (RandomDrive& drive : drives) {
      while (drive.due() < t + kPhysicsStep) drive.act(std::max(drive.due(), t));
    }
    for (std::size_t i = 0; i < world.robot_count(); ++i) {
      errors_mm.push_back(static_cast<float>(1000 * world.reference_error_m(i)));
      top_speed = std::max(top_speed, world.bodies()[i].velocity_mps().norm());
    }
  }
  REQUIRE(world.firmware_violations() == 0);
  REQUIRE(world.contacts().contacts == 0);
  for (std::size_t i = 0; i < world.robot_count(); ++i) {
    REQUIRE(world.firmware(i).counts().activated > 50 * seconds);
    REQUIRE(world.firmware(i).counts().refused_malformed == 0);
  }
  std::sort(errors_mm.begin(), errors_mm.end());
  const auto quantile = [&errors_mm](double q) {
    return errors_mm[static_cast<std::size_t>(q * static_cast<double>(errors_mm.size() - 1))];
  };
  return {quantile(0.5), quantile(0.99), quantile(1), top_speed};
}

// 20 robots drive for 15 s each: five minutes of random versions with acceleration steps of up to 8 m/s²
// every cycle. Some versions are lost.
TEST_CASE("bodies stay within 5 mm of their references, and mostly within 3 mm") {
  const std::uint64_t seed = GENERATE(1, 2);
  Scenario scenario = separated_robots(20);
  scenario.command_loss = 0.05;
  scenario.tracking_bound_m = 0.02;  // prevents own stops, so that the test measures tracking alone
  SECTION("with the default noise") {}
  SECTION("with noisy and late vision") {
    scenario.vision.position_noise_m = 0.0015;
    scenario.vision.delay = std::chrono::milliseconds(35);
    scenario.vision.miss_probability = 0.02;
  }
  const ErrorQuantiles error = measure_tracking(scenario, 15, seed);
  INFO("seed " << seed << ": median " << error.median_mm << " mm, p99 " << error.p99_mm << " mm, max "
               << error.max_mm << " mm, top speed " << error.top_speed_mps << " m/s");
  CHECK(error.median_mm < 1.5);
  CHECK(error.p99_mm < 3);
  CHECK(error.max_mm < 5);
  CHECK(error.top_speed_mps > 1.9);
}

TEST_CASE("a resting robot that no camera sees stays where it is") {
  const Scenario scenario = separated_robots(5);
  const Time begin = time_from_ns(1'700'000'000'000'000'000);
  World world(scenario, begin, 4);
  world.advance(begin + std::chrono::seconds(120));
  for (std::size_t i = 0; i < world.robot_count(); ++i) {
    CAPTURE(i);
    CHECK(world.reference_error_m(i) < 0.001);
    CHECK(world.firmware(i).own_stops() == 0);
  }
}

TEST_CASE("a robot without further commands comes to rest where its version ends") {
  Scenario scenario = separated_robots(5);
  const Time begin = time_from_ns(1'700'000'000'000'000'000);
  World world(scenario, begin, 3);
  std::vector<RandomDrive> drives;
  for (std::size_t i = 0; i < world.robot_count(); ++i) drives.emplace_back(scenario, world, i, i);
  Time t = begin;
  for (; t < begin + std::chrono::seconds(5); t += kPhysicsStep) {
    world.advance(t);
    for (RandomDrive& drive : drives) {
      while (drive.due() < t + kPhysicsStep) drive.act(std::max(drive.due(), t));
    }
  }
  world.advance(t + std::chrono::seconds(2));
  for (std::size_t i = 0; i < world.robot_count(); ++i) {
    CAPTURE(i);
    const Vec2 rest = world.firmware(i).executing().trajectory.rest_position_m();
    CHECK(world.firmware(i).executing().number > 0);
    CHECK((world.bodies()[i].position_m() - rest).norm() < 0.003);
    CHECK(world.bodies()[i].velocity_mps().norm() < 0.02);
  }
}

}  // namespace sidestep::tracking_test
