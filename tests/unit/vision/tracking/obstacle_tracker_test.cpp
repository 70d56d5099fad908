// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/obstacle_tracker.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <set>

#include "tests/unit/vision/floor.hpp"

using namespace sidestep;
using namespace sidestep::test;

namespace {

void add_obstacle(msg::DetectionFrame& frame, const Vec2& position_m, double radius_m = 0.1) {
  auto& d = frame.obstacles().at(frame.obstacle_count());
  d.x_m(position_m.x());
  d.y_m(position_m.y());
  d.radius_m(radius_m);
  frame.obstacle_count(static_cast<std::uint8_t>(frame.obstacle_count() + 1));
}

msg::DetectionFrame empty_frame(std::uint32_t camera, Time at) {
  auto frame = frame_message(camera, at);
  frame.obstacle_count(0);
  return frame;
}

/// Walks to and fro on a segment at a constant speed, turning in no time.
struct Walker {
  Vec2 from_m, to_m;
  double speed_mps;
  Vec2 at(Time t) const {
    const double length = (to_m - from_m).norm();
    double way = std::fmod(speed_mps * to_seconds(t - kBegin), 2 * length);
    if (way > length) way = 2 * length - way;
    return from_m + (to_m - from_m) * (way / length);
  }
};

const msg::TrackedObstacle* nearest(const msg::WorldState& world, const Vec2& to_m) {
  const msg::TrackedObstacle* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < world.obstacle_count(); ++i) {
    const auto& o = world.obstacles()[i];
    const double distance = (Vec2(o.x_m(), o.y_m()) - to_m).norm();
    if (distance < least) best = &o, least = distance;
  }
  return best;
}

}  // namespace

TEST_CASE("walkers keep their numbers and are where they were last seen, fused over two cameras") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  const double missed = GENERATE(0.0, 0.2);
  CAPTURE(seed, missed);
  Rng rng(seed);
  const double noise_m = 0.002;
  const std::vector<Walker> walkers{
      {{-2, 0}, {2, 0}, 1.5}, {{-1, 1}, {1, 1.5}, 1}, {{0, -2}, {0.5, -1}, 0.7}};
  Watcher watcher(0);
  std::vector<std::set<std::uint32_t>> numbers(walkers.size());
  double square = 0;
  int count = 0;
  Time seen{};
  for (int k = 0; k < 1200; ++k) {
    const Time t = kBegin + kFrame / 2 * k;
    auto frame = empty_frame(k % 2, t);
    std::vector<bool> in_frame;
    for (const Walker& walker : walkers) {
      in_frame.push_back(!rng.chance(missed));
      if (!in_frame.back()) continue;
      add_obstacle(frame, walker.at(t) + noise_m * Vec2(rng.normal(), rng.normal()));
    }
    watcher.feed(frame);
    if (k < 40) continue;
    const auto& world = watcher.world_at(t + kFrame);
    REQUIRE(world.obstacle_count() == walkers.size());
    for (std::size_t i = 0; i < walkers.size(); ++i) {
      const auto* found = nearest(world, walkers[i].at(t));
      numbers[i].insert(found->obstacle());
      seen = time_from_ns(found->seen_at_ns());
      REQUIRE(seen <= t);
      if (in_frame[i]) REQUIRE(seen == t);
      const Vec2 error = Vec2(found->x_m(), found->y_m()) - walkers[i].at(seen);
      REQUIRE(error.norm() < 6 * noise_m);
      REQUIRE(found->radius_m() == Approx(0.1));
      square += error.squaredNorm();
      ++count;
    }
  }
  CHECK(std::sqrt(square / (2 * count)) < 1.2 * noise_m);
  for (const auto& of_walker : numbers) CHECK(of_walker.size() == 1);
  CHECK(watcher.world_at(kBegin).rejected() == 0);
}

TEST_CASE("an obstacle is published after its second sight, and dropped a second after its last") {
  Watcher watcher(0);
  auto frame = empty_frame(0, kBegin);
  add_obstacle(frame, {1, 1});
  watcher.feed(frame);
  CHECK(watcher.world_at(kBegin).obstacle_count() == 0);
  frame.captured_at_ns(to_ns(kBegin + kFrame));
  watcher.feed(frame);
  CHECK(watcher.world_at(kBegin + kFrame).obstacle_count() == 1);
  CHECK(watcher.world_at(kBegin + kFrame + 1000 * kMs).obstacle_count() == 1);
  CHECK(watcher.world_at(kBegin + kFrame + 1001 * kMs).obstacle_count() == 0);
  const auto first = watcher.world_at(kBegin + kFrame).obstacles()[0].obstacle();
  for (int i = 0; i < 2; ++i) {
    frame.captured_at_ns(to_ns(kBegin + 3000 * kMs + i * kFrame));
    watcher.feed(frame);
  }
  REQUIRE(watcher.world_at(kBegin + 3100 * kMs).obstacle_count() == 1);
  CHECK(watcher.world_at(kBegin + 3100 * kMs).obstacles()[0].obstacle() > first);
}

TEST_CASE("frames that come late or twice add nothing and begin no track") {
  Rng rng(5);
  const Walker walker{{-2, 0}, {2, 0}, 1.5};
  Watcher watcher(0);
  std::vector<msg::DetectionFrame> frames;
  for (int k = 0; k < 120; ++k) {
    frames.push_back(empty_frame(0, kBegin + kFrame * k));
    add_obstacle(frames.back(), walker.at(kBegin + kFrame * k));
  }
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Time now = kBegin + kFrame * static_cast<int>(k);
    watcher.feed(frames[k], now);
    if (k > 3) watcher.feed(frames[k - 1 - rng.below(3)], now);
    if (k > 1) REQUIRE(watcher.world_at(now).obstacle_count() == 1);
  }
  const auto& world = watcher.world_at(kBegin + kFrame * 119);
  CHECK(world.obstacles()[0].obstacle() == 1);
  CHECK(world.obstacles()[0].seen_at_ns() == to_ns(kBegin + kFrame * 119));
  CHECK(world.obstacles()[0].vx_mps() == Approx(1.5).margin(0.1));
}

TEST_CASE("of more obstacles than a message holds those seen last are told") {
  Watcher watcher(0);
  for (int k = 0; k < 3; ++k) {
    for (const double y : {0.0, 3.0}) {
      auto frame = empty_frame(0, kBegin + kFrame * k + (y > 0 ? kMs : Duration(0)));
      for (std::size_t i = 0; i < msg::MAX_OBSTACLES; ++i)
        add_obstacle(frame, {0.5 * static_cast<double>(i), y});
      watcher.feed(frame);
    }
  }
  const auto& world = watcher.world_at(kBegin + 3 * kFrame);
  REQUIRE(world.obstacle_count() == msg::MAX_OBSTACLES);
  for (std::size_t i = 0; i < world.obstacle_count(); ++i) CHECK(world.obstacles()[i].y_m() == Approx(3));
  // There is no room for a third row of tracks.
  auto frame = empty_frame(0, kBegin + 3 * kFrame);
  for (std::size_t i = 0; i < msg::MAX_OBSTACLES; ++i)
    add_obstacle(frame, {0.5 * static_cast<double>(i), -3});
  watcher.feed(frame);
  CHECK(watcher.world_at(kBegin + 3 * kFrame).rejected() == msg::MAX_OBSTACLES);
}

TEST_CASE("obstacles that make no sense are dropped alone, and a wrong count with its frame") {
  auto message = empty_frame(0, kBegin);
  add_obstacle(message, {1, 2});
  Frame frame;
  auto& d = message.obstacles()[0];
  const double bad = GENERATE(std::numeric_limits<double>::quiet_NaN(), 1e300, -101.0);
  SECTION("x") { d.x_m(bad); }
  SECTION("y") { d.y_m(bad); }
  SECTION("radius") { d.radius_m(bad); }
  SECTION("no radius") { d.radius_m(0); }
  add_obstacle(message, {3, 4});
  frame.assign(message, kBegin);
  REQUIRE(frame.obstacles().size() == 1);
  CHECK(frame.obstacles()[0].position_m == Vec2(3, 4));
  CHECK(frame.rejected() == 1);
  message.obstacle_count(17);
  frame.assign(message, kBegin);
  CHECK_FALSE(frame.is_usable());
  CHECK(frame.obstacles().empty());
}

TEST_CASE(
    "a robot that was pushed is published beside its track after two sights, not only when it is lost") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  Rng rng(seed);
  Watcher watcher(1);
  const double jump_m = GENERATE(0.01, 0.03, 0.07);
  Time t = kBegin;
  const auto frame = [&](const Vec2& position_m) {
    auto message = empty_frame(0, t += kFrame);
    see(message, 0, {position_m, {0, 0}, 0}, {0.0005, 0.005}, rng);
    watcher.feed(message);
    return watcher.robot_at(0, t);
  };
  for (int i = 0; i < 60; ++i) frame({1, 1});
  frame({1 + jump_m, 1});
  const auto* robot = frame({1 + jump_m, 1});
  REQUIRE(robot);
  CHECK(robot->seen_at_ns() == to_ns(t));
  CHECK((seen_of(*robot) - Vec2(1 + jump_m, 1)).norm() < 0.003);
}
