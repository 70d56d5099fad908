// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "tests/counted_allocations.hpp"
#include "tests/unit/vision/floor.hpp"

using namespace sidestep;
using namespace sidestep::test;

namespace {

struct Arrival {
  Time at;
  msg::DetectionFrame frame;
};

/// Two cameras' frames of three robots, one of which comes late into the picture, with ghosts, misses and a
/// ball.
std::vector<Arrival> frames_of_two_cameras(Rng& rng, double duration_s) {
  std::vector<TrueMotion> motions;
  for (int i = 0; i < 3; ++i) motions.push_back(TrueMotion::driving(rng, duration_s));
  std::vector<Arrival> frames;
  for (Time t = kBegin; t < after_s(duration_s); t += kFrame) {
    for (std::uint32_t camera = 0; camera < 2; ++camera) {
      const Time captured = t + static_cast<int>(camera) * 5 * kMs;
      msg::DetectionFrame frame = frame_message(camera, captured);
      for (RobotId id = 0; id < 3; ++id) {
        if (id == 2 && t < after_s(0.5)) continue;
        if (!rng.chance(0.05)) see(frame, id, motions[id].at(captured), {}, rng);
        if (rng.chance(0.05)) add_robot(frame, id, {rng.uniform(-3, 3), rng.uniform(-3, 3)});
      }
      if (!rng.chance(0.1)) add_ball(frame, {rng.normal() * 0.001, 1});
      frames.push_back({captured, frame});
    }
  }
  return frames;
}

bool by_arrival(const Arrival& a, const Arrival& b) { return a.at < b.at; }

}  // namespace

TEST_CASE(
    "frames that come late, out of order and twice give the same world, bit for bit, as frames in order") {
  const std::uint64_t seed = GENERATE(range(200u, 220u));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<Arrival> in_order = frames_of_two_cameras(rng, 3);
  std::vector<Arrival> shuffled;
  for (const Arrival& frame : in_order) {
    shuffled.push_back({frame.at + from_seconds(rng.uniform(0, 0.15)), frame.frame});
    if (rng.chance(0.1)) shuffled.push_back({frame.at + from_seconds(rng.uniform(0, 0.15)), frame.frame});
  }
  std::stable_sort(shuffled.begin(), shuffled.end(), by_arrival);

  Watcher expected(3), watcher(3);
  for (const Arrival& frame : in_order) expected.feed(frame.frame, frame.at);
  for (const Arrival& frame : shuffled) watcher.feed(frame.frame, frame.at);
  const Time end = after_s(3.1);
  REQUIRE(expected.world_at(end).robots().size() == 3);
  CHECK(expected.world_at(end).rejected() > 0);
  CHECK(expected.world_at(end).frames() == in_order.size());
  CHECK(watcher.world_at(end) == expected.world_at(end));
}

TEST_CASE("a frame that is older than all that is kept changes nothing and is counted") {
  Rng rng(231);
  Watcher watcher(1);
  for (int i = 0; i < 40; ++i) {
    if (i == 1) continue;
    msg::DetectionFrame frame = frame_message(0, kBegin + i * kFrame / 2);
    see(frame, 0, {}, {}, rng);
    watcher.feed(frame);
  }
  const Time now = kBegin + 20 * kFrame;
  const msg::WorldState before = watcher.world_at(now);
  msg::DetectionFrame late = frame_message(0, kBegin + kFrame / 2);
  see(late, 0, {}, {}, rng);
  watcher.feed(late, now);
  msg::WorldState expected = before;
  expected.rejected(before.rejected() + 1);
  CHECK(watcher.world_at(now) == expected);
}

TEST_CASE("a frame that belongs right after all that is no longer kept is still taken in as if in order") {
  Rng rng(235);
  std::vector<msg::DetectionFrame> frames;
  for (int i = 0; i < 40; ++i) {
    frames.push_back(frame_message(0, kBegin + i * kFrame / 2));
    see(frames.back(), 0, {}, {}, rng);
  }
  Watcher expected(1), watcher(1);
  for (const auto& frame : frames) expected.feed(frame);
  // Of 39 sights the last 32 are kept: from number 7 on.
  const std::size_t late = 8;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i != late) watcher.feed(frames[i]);
  }
  const Time now = kBegin + 20 * kFrame;
  CHECK(watcher.world_at(now) != expected.world_at(now));
  watcher.feed(frames[late], now);
  CHECK(watcher.world_at(now) == expected.world_at(now));
}

TEST_CASE("updates and publications allocate nothing") {
  Rng rng(241);
  const std::vector<Arrival> frames = frames_of_two_cameras(rng, 1);
  Watcher watcher(3);
  watcher.world_at(kBegin);
  const std::size_t before = allocations();
  for (const Arrival& frame : frames) {
    watcher.feed(frame.frame, frame.at);
    watcher.world_at(frame.at);
  }
  CHECK(allocations() == before);
}

TEST_CASE("any numbers in any frame leave the tracker alive and its world finite") {
  const std::uint64_t seed = GENERATE(range(250u, 260u));
  CAPTURE(seed);
  Rng rng(seed);
  Watcher watcher(4);
  const auto number = [&rng](double usual) {
    const double odd[] = {0, -0.0, 1e-310, 100, -100, 101, 1e308, INFINITY, -INFINITY, NAN};
    return rng.chance(0.1) ? odd[rng.below(10)] : usual * rng.normal();
  };
  for (int i = 0; i < 2000; ++i) {
    const Time now = kBegin + i * 2 * kMs;
    msg::DetectionFrame frame = frame_message(static_cast<std::uint32_t>(rng.below(3)), now);
    frame.captured_at_ns(to_ns(now) + static_cast<std::int64_t>(number(1e8)) % 1'000'000'000);
    for (std::uint64_t n = rng.below(20); n > 0; --n) {
      add_robot(frame, static_cast<RobotId>(rng.below(6)), {number(0.1), number(0.1)});
      frame.robots().back().heading_rad(number(3));
      frame.robots().back().confidence(rng.chance(0.1) ? number(1) : 0.5);
    }
    frame.ball_count(static_cast<std::uint8_t>(rng.below(6)));
    for (auto& ball : frame.balls()) ball.x_m(number(1)), ball.y_m(number(1)), ball.confidence(0.5);
    watcher.feed(frame, now);
    const auto& world = watcher.world_at(now);
    REQUIRE(world.robots().size() <= 4);
    for (const auto& robot : world.robots()) {
      REQUIRE(
          std::isfinite(robot.x_m() + robot.y_m() + robot.vx_mps() + robot.vy_mps() + robot.heading_rad()));
      REQUIRE(std::isfinite(robot.angular_radps() + robot.seen_x_m() + robot.seen_y_m()));
      REQUIRE(robot.position_variance_m2() > 0);
      REQUIRE(robot.velocity_variance_m2ps2() > 0);
    }
    const auto& ball = world.ball();
    if (ball.is_visible()) REQUIRE(std::isfinite(ball.x_m() + ball.y_m() + ball.vx_mps() + ball.vy_mps()));
  }
  CHECK(watcher.world_at(kBegin).rejected() > 0);
}
