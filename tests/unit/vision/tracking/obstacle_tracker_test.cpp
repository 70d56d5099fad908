// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/obstacle_tracker.hpp"

#include <limits>
#include <map>
#include <set>

#include "common/geometry/coordinate_bound.hpp"
#include "tests/catch.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::obstacle_tracker_test {

using namespace sidestep::test;

msg::DetectionFrame empty_frame(std::uint32_t camera, Time at) {
  auto frame = frame_message(camera, at);
  frame.obstacle_count(0);
  return frame;
}

/// Walks back and forth along a segment at a constant speed, turning instantly.
struct Walker {
  Vec2 from_m, to_m;
  double speed_mps;
  Vec2 at(Time t) const {
    const double length = (to_m - from_m).norm();
    double distance = std::fmod(speed_mps * to_seconds(t - kBegin), 2 * length);
    if (distance > length) distance = 2 * length - distance;
    return from_m + (to_m - from_m) * (distance / length);
  }
};

const msg::TrackedObstacle* nearest(const msg::ObstacleList& list, const Vec2& to_m) {
  const msg::TrackedObstacle* best = nullptr;
  double min_distance = std::numeric_limits<double>::infinity();
  for (const msg::TrackedObstacle& o : list.obstacles()) {
    const double distance = (Vec2(o.x_m(), o.y_m()) - to_m).norm();
    if (distance < min_distance) best = &o, min_distance = distance;
  }
  return best;
}

TEST_CASE("what cameras disagree by adds to the uncertainty of obstacles, however often they are seen") {
  TrackerFixture fixture(0);
  const auto variance_m2 = [&](int first) {
    for (int k = first; k < first + 60; ++k) {
      auto frame = empty_frame(0, kBegin + k * kFrame);
      frame.obstacle_count(1);
      frame.obstacles()[0].x_m(1);
      frame.obstacles()[0].radius_m(0.1);
      fixture.feed(frame);
    }
    const msg::ObstacleList& list = fixture.obstacles_at(kBegin + (first + 60) * kFrame);
    REQUIRE(list.obstacles().size() == 1);
    return list.obstacles()[0].position_variance_m2();
  };
  const double alone_m2 = variance_m2(0);
  fixture.set_camera_error(0.02);
  CHECK(variance_m2(60) == Approx(alone_m2 + 0.0004).epsilon(0.01));
  fixture.set_camera_error(0);
  CHECK(variance_m2(120) == Approx(alone_m2).epsilon(0.01));
}

TEST_CASE("walkers seen by two cameras keep their numbers and are reported where they were last observed") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  const double missed = GENERATE(0.0, 0.2);
  CAPTURE(seed, missed);
  Rng rng(seed);
  const double noise_m = 0.002;
  const std::vector<Walker> walkers{
      {{-2, 0}, {2, 0}, 1.5}, {{-1, 1}, {1, 1.5}, 1}, {{0, -2}, {0.5, -1}, 0.7}};
  TrackerFixture fixture(0);
  std::vector<std::set<std::uint32_t>> numbers(walkers.size());
  double square = 0;
  int count = 0;
  Time observed_at{};
  for (int k = 0; k < 1200; ++k) {
    const Time t = kBegin + kFrame / 2 * k;
    auto frame = empty_frame(k % 2, t);
    std::vector<bool> in_frame;
    for (const Walker& walker : walkers) {
      in_frame.push_back(!rng.chance(missed));
      if (!in_frame.back()) continue;
      add_obstacle(frame, walker.at(t) + noise_m * normal_vector(rng));
    }
    fixture.feed(frame);
    if (k < 40) continue;
    const auto& list = fixture.obstacles_at(t + kFrame);
    REQUIRE(list.obstacles().size() == walkers.size());
    REQUIRE(list.complete_within_m() == kCompleteEverywhere_m);
    for (std::size_t i = 0; i < walkers.size(); ++i) {
      const auto* found = nearest(list, walkers[i].at(t));
      numbers[i].insert(found->obstacle());
      observed_at = time_from_ns(found->observed_at_ns());
      REQUIRE(observed_at <= t);
      if (in_frame[i]) REQUIRE(observed_at == t);
      const Vec2 error = Vec2(found->x_m(), found->y_m()) - walkers[i].at(observed_at);
      REQUIRE(error.norm() < 6 * noise_m);
      REQUIRE(found->radius_m() == Approx(0.1));
      square += error.squaredNorm();
      ++count;
    }
  }
  CHECK(std::sqrt(square / (2 * count)) < 1.2 * noise_m);
  for (const auto& of_walker : numbers) CHECK(of_walker.size() == 1);
  CHECK(fixture.rejected() == 0);
}

TEST_CASE("an obstacle is published after its second observation and dropped 1 s after its last") {
  TrackerFixture fixture(0);
  auto frame = empty_frame(0, kBegin);
  add_obstacle(frame, {1, 1});
  fixture.feed(frame);
  CHECK(fixture.obstacles_at(kBegin).obstacles().size() == 0);
  frame.captured_at_ns(to_ns(kBegin + kFrame));
  fixture.feed(frame);
  CHECK(fixture.obstacles_at(kBegin + kFrame).obstacles().size() == 1);
  CHECK(fixture.obstacles_at(kBegin + kFrame + 1000 * kMs).obstacles().size() == 1);
  CHECK(fixture.obstacles_at(kBegin + kFrame + 1001 * kMs).obstacles().size() == 0);
  const auto first = fixture.obstacles_at(kBegin + kFrame).obstacles()[0].obstacle();
  for (int i = 0; i < 2; ++i) {
    frame.captured_at_ns(to_ns(kBegin + 3000 * kMs + i * kFrame));
    fixture.feed(frame);
  }
  REQUIRE(fixture.obstacles_at(kBegin + 3100 * kMs).obstacles().size() == 1);
  CHECK(fixture.obstacles_at(kBegin + 3100 * kMs).obstacles()[0].obstacle() > first);
}

TEST_CASE("an obstacle in frames with an uncertain date may have moved since the earliest possible date") {
  TrackerFixture fixture(0);
  const auto feed = [&](Time at, Duration date_uncertainty) {
    auto frame = empty_frame(0, at);
    add_obstacle(frame, {1, 1});
    fixture.feed(frame, at, date_uncertainty);
    const auto& list = fixture.obstacles_at(at);
    return list.obstacles().empty() ? Time{} : time_from_ns(list.obstacles()[0].observed_at_ns());
  };
  (void)feed(kBegin, 10 * kMs);
  CHECK(feed(kBegin + kFrame, 15 * kMs) == kBegin + kFrame - 15 * kMs);
  CHECK(feed(kBegin + 2 * kFrame, Duration{0}) == kBegin + 2 * kFrame);
}

TEST_CASE("late and duplicate frames neither change tracks nor start new ones") {
  Rng rng(5);
  const Walker walker{{-2, 0}, {2, 0}, 1.5};
  TrackerFixture fixture(0);
  std::vector<msg::DetectionFrame> frames;
  for (int k = 0; k < 120; ++k) {
    frames.push_back(empty_frame(0, kBegin + kFrame * k));
    add_obstacle(frames.back(), walker.at(kBegin + kFrame * k));
  }
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Time now = kBegin + kFrame * static_cast<int>(k);
    fixture.feed(frames[k], now);
    if (k > 3) fixture.feed(frames[k - 1 - rng.below(3)], now);
    if (k > 1) REQUIRE(fixture.obstacles_at(now).obstacles().size() == 1);
  }
  const auto& list = fixture.obstacles_at(kBegin + kFrame * 119);
  CHECK(list.obstacles()[0].obstacle() == 1);
  CHECK(list.obstacles()[0].observed_at_ns() == to_ns(kBegin + kFrame * 119));
  CHECK(list.obstacles()[0].vx_mps() == Approx(1.5).margin(0.1));
}

TEST_CASE("an invalid obstacle alone is dropped, but an invalid count drops the whole frame") {
  auto message = empty_frame(0, kBegin);
  add_obstacle(message, {1, 2});
  Frame frame;
  auto& d = message.obstacles()[0];
  const double bad = GENERATE(std::numeric_limits<double>::quiet_NaN(), 1e300, -1.001 * kMaxCoordinate_m);
  SECTION("x") { d.x_m(bad); }
  SECTION("y") { d.y_m(bad); }
  SECTION("radius") { d.radius_m(bad); }
  SECTION("zero radius") { d.radius_m(0); }
  add_obstacle(message, {3, 4});
  frame.assign(message, kBegin);
  REQUIRE(frame.obstacles().size() == 1);
  CHECK(frame.obstacles()[0].position_m == Vec2(3, 4));
  CHECK(frame.rejected() == 1);
  message.obstacle_count(msg::MAX_OBSTACLES + 1);
  frame.assign(message, kBegin);
  CHECK_FALSE(frame.is_usable());
  CHECK(frame.obstacles().empty());
}

TEST_CASE("a robot that was pushed is published at its new position after two observations") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  Rng rng(seed);
  TrackerFixture fixture(1);
  const double jump_m = GENERATE(0.01, 0.03, 0.07);
  Time t = kBegin;
  const auto frame = [&](const Vec2& position_m) {
    auto message = empty_frame(0, t += kFrame);
    add_noisy_robot(message, 0, {position_m, {0, 0}, 0}, {0.0005, 0.005}, rng);
    fixture.feed(message);
    return fixture.robot_at(0, t);
  };
  for (int i = 0; i < 60; ++i) frame({1, 1});
  frame({1 + jump_m, 1});
  const auto* robot = frame({1 + jump_m, 1});
  REQUIRE(robot);
  CHECK(robot->observed_at_ns() == to_ns(t));
  CHECK((observed_position_of(*robot) - Vec2(1 + jump_m, 1)).norm() < 0.003);
}

}  // namespace sidestep::obstacle_tracker_test
