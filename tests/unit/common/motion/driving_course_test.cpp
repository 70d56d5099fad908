// SPDX-License-Identifier: Apache-2.0
#include "common/motion/driving_course.hpp"

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::driving_course_test {

using namespace std::chrono_literals;

constexpr Time kStart = time_from_ns(1'800'000'000'000'000'000);

/// Up to three phases of constant acceleration and a stop, which all begin and end at samples.
Trajectory sampled_trajectory(Rng& rng) {
  Vec2 velocity = random_vector(rng, 2);
  Trajectory trajectory(kStart, {random_vector(rng, 5), velocity});
  const auto append = [&](auto acceleration_for) {
    const Duration duration = static_cast<int>(1 + rng.below(8)) * DrivingCourse::kSample;
    const Vec2 acceleration = acceleration_for(to_seconds(duration));
    trajectory.append(duration, acceleration);
    velocity += to_seconds(duration) * acceleration;
  };
  for (std::uint64_t phases = rng.below(4); phases > 0; --phases)
    append([&](double) { return random_vector(rng, 3); });
  append([&](double duration_s) -> Vec2 { return -velocity / duration_s; });
  return trajectory;
}

DrivingCourse course_along(const Trajectory& trajectory) {
  DrivingCourse course;
  course.start = trajectory.start();
  for (Time t = trajectory.start(); t <= trajectory.end(); t += DrivingCourse::kSample)
    course.states.push_back(trajectory.state_at(t));
  return course;
}

TEST_CASE("a course follows its samples exactly where the acceleration is constant between them") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 1000; ++i) {
    const Trajectory trajectory = sampled_trajectory(rng);
    const DrivingCourse course = course_along(trajectory);
    REQUIRE(course.end() == trajectory.end());
    const double duration_s = to_seconds(course.end() - course.start);
    for (int k = 0; k < 20; ++k) {
      const Time t = course.start + from_seconds(rng.uniform(0, duration_s));
      CAPTURE(i, to_seconds(t - course.start));
      const State expected = trajectory.state_at(t), state = course.state_at(t);
      REQUIRE((state.position_m - expected.position_m).norm() < 1e-11);
      REQUIRE((state.velocity_mps - expected.velocity_mps).norm() < 1e-11);
    }
  }
}

TEST_CASE("a course has the state of each sample at the time of the sample") {
  Rng rng(4);
  const DrivingCourse course = course_along(sampled_trajectory(rng));
  for (std::size_t i = 0; i < course.states.size(); ++i) {
    CAPTURE(i);
    const Time t = course.start + DrivingCourse::kSample * static_cast<std::int64_t>(i);
    CHECK(course.state_at(t).position_m == course.states[i].position_m);
    CHECK(course.state_at(t).velocity_mps == course.states[i].velocity_mps);
    CHECK(course.position_at(t) == course.states[i].position_m);
  }
}

TEST_CASE("a robot rests at its first place before its course starts and at its goal after it ends") {
  DrivingCourse course;
  course.start = kStart;
  course.states = {{{1, 2}, {0.5, 0}}, {{1.02, 2}, {0.3, 0}}, {{1.03, 2}, {0, 0}}};
  CHECK(course.goal_m() == Vec2(1.03, 2));
  CHECK(course.end() == kStart + 100ms);
  for (const Duration before : {Duration{1}, Duration{60ms}, Duration{1h}}) {
    CAPTURE(before.count());
    CHECK(course.state_at(kStart - before).position_m == Vec2(1, 2));
    CHECK(course.state_at(kStart - before).velocity_mps == Vec2(0, 0));
    CHECK(course.position_at(kStart - before) == Vec2(1, 2));
  }
  for (const Duration after : {Duration{0}, Duration{1}, Duration{60ms}, Duration{1h}}) {
    CAPTURE(after.count());
    CHECK(course.state_at(course.end() + after).position_m == course.goal_m());
    CHECK(course.state_at(course.end() + after).velocity_mps == Vec2(0, 0));
    CHECK(course.position_at(course.end() + after) == course.goal_m());
  }
}

TEST_CASE("a course of one sample is a robot at rest") {
  DrivingCourse course;
  course.start = kStart;
  course.states = {{{1, 2}, {0, 0}}};
  CHECK(course.end() == kStart);
  for (const Time t : {kStart - 1s, kStart, kStart + 1s}) {
    CHECK(course.state_at(t).position_m == Vec2(1, 2));
    CHECK(course.state_at(t).velocity_mps == Vec2(0, 0));
    CHECK(course.position_at(t) == Vec2(1, 2));
  }
}

TEST_CASE("positions between two samples are on the straight line between them, in proportion to time") {
  Rng rng(5);
  DrivingCourse course;
  course.start = kStart;
  for (int i = 0; i < 10; ++i) course.states.push_back({random_vector(rng, 1), random_vector(rng, 2)});
  for (std::size_t i = 0; i + 1 < course.states.size(); ++i) {
    const Vec2 a = course.states[i].position_m, b = course.states[i + 1].position_m;
    for (const int ms : {1, 10, 25, 49}) {
      CAPTURE(i, ms);
      const Time t = kStart + DrivingCourse::kSample * static_cast<std::int64_t>(i) + ms * 1ms;
      CHECK((course.position_at(t) - (a + ms / 50.0 * (b - a))).norm() < 1e-12);
    }
  }
}

TEST_CASE("a course without states is empty") {
  DrivingCourse course;
  CHECK(course.is_empty());
  course.states.push_back({});
  CHECK_FALSE(course.is_empty());
}

}  // namespace sidestep::driving_course_test
