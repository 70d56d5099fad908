// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/coordinate_bound.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::tracker_order_test {

using namespace sidestep::test;

struct Arrival {
  Time at;
  msg::DetectionFrame frame;
};

/// Two cameras' frames of three robots, one of which appears later, with ghosts, misses and a ball.
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
        if (!rng.chance(0.05)) add_noisy_robot(frame, id, motions[id].at(captured), {}, rng);
        if (rng.chance(0.05)) add_robot(frame, id, {rng.uniform(-3, 3), rng.uniform(-3, 3)});
      }
      if (!rng.chance(0.1)) add_ball(frame, {rng.normal() * 0.001, 1});
      frames.push_back({captured, frame});
    }
  }
  return frames;
}

bool by_arrival(const Arrival& a, const Arrival& b) { return a.at < b.at; }

TEST_CASE("late, reordered and duplicate frames give the same world state, bit for bit, as frames in order") {
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

  TrackerFixture expected(3), fixture(3);
  for (const Arrival& frame : in_order) expected.feed(frame.frame, frame.at);
  for (const Arrival& frame : shuffled) fixture.feed(frame.frame, frame.at);
  const Time end = after_s(3.1);
  REQUIRE(expected.world_at(end).robots().size() == 3);
  CHECK(expected.rejected() > 0);
  CHECK(expected.world_at(end).frames() == in_order.size());
  CHECK(fixture.world_at(end) == expected.world_at(end));
  CHECK(fixture.rejected() == expected.rejected());
}

TEST_CASE("a frame older than the stored history changes nothing and is counted") {
  Rng rng(231);
  TrackerFixture fixture(1);
  for (int i = 0; i < 40; ++i) {
    if (i == 1) continue;
    msg::DetectionFrame frame = frame_message(0, kBegin + i * kFrame / 2);
    add_noisy_robot(frame, 0, {}, {}, rng);
    fixture.feed(frame);
  }
  const Time now = kBegin + 20 * kFrame;
  const msg::WorldState before = fixture.world_at(now);
  const std::uint64_t rejected_before = fixture.rejected();
  msg::DetectionFrame late = frame_message(0, kBegin + kFrame / 2);
  add_noisy_robot(late, 0, {}, {}, rng);
  fixture.feed(late, now);
  CHECK(fixture.world_at(now) == before);
  CHECK(fixture.rejected() == rejected_before + 1);
}

TEST_CASE("a frame at the start of the stored history is processed as if in order") {
  Rng rng(235);
  std::vector<msg::DetectionFrame> frames;
  for (int i = 0; i < 40; ++i) {
    frames.push_back(frame_message(0, kBegin + i * kFrame / 2));
    add_noisy_robot(frames.back(), 0, {}, {}, rng);
  }
  TrackerFixture expected(1), fixture(1);
  for (const auto& frame : frames) expected.feed(frame);
  // Of 39 observations, the last 32 are stored, from number 7 on.
  const std::size_t late = 8;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i != late) fixture.feed(frames[i]);
  }
  const Time now = kBegin + 20 * kFrame;
  CHECK(fixture.world_at(now) != expected.world_at(now));
  fixture.feed(frames[late], now);
  CHECK(fixture.world_at(now) == expected.world_at(now));
}

TEST_CASE("updating the tracker and publishing do not allocate memory") {
  Rng rng(241);
  const std::vector<Arrival> frames = frames_of_two_cameras(rng, 1);
  TrackerFixture fixture(3);
  fixture.world_at(kBegin);
  const std::size_t before = allocation_count();
  for (const Arrival& frame : frames) {
    fixture.feed(frame.frame, frame.at);
    fixture.world_at(frame.at);
  }
  CHECK(allocation_count() == before);
}

TEST_CASE("the world state remains finite for frames with arbitrary numbers") {
  const std::uint64_t seed = GENERATE(range(250u, 260u));
  CAPTURE(seed);
  Rng rng(seed);
  TrackerFixture fixture(4);
  const auto number = [&rng](double usual) {
    const double odd[] = {
        0,        -0.0,      1e-310, kMaxCoordinate_m, -kMaxCoordinate_m, 1.01 * kMaxCoordinate_m, 1e308,
        INFINITY, -INFINITY, NAN};
    return rng.chance(0.1) ? odd[rng.below(10)] : usual * rng.normal();
  };
  for (int i = 0; i < 2000; ++i) {
    const Time now = kBegin + i * 2 * kMs;
    msg::DetectionFrame frame = frame_message(static_cast<std::uint32_t>(rng.below(3)), now);
    frame.captured_at_ns(to_ns(now) + static_cast<std::int64_t>(number(1e8)) % 1'000'000'000);
    for (std::uint64_t n = rng.below(20); n > 0; --n) {
      const Vec2 position_m{number(0.1), number(0.1)};
      add_robot(frame, static_cast<RobotId>(rng.below(6)), position_m);
      frame.robots().back().heading_rad(number(3));
      frame.robots().back().confidence(rng.chance(0.1) ? number(1) : 0.5);
    }
    frame.ball_count(static_cast<std::uint8_t>(rng.below(6)));
    for (auto& ball : frame.balls()) ball.x_m(number(1)), ball.y_m(number(1)), ball.confidence(0.5);
    fixture.feed(frame, now);
    const auto& world = fixture.world_at(now);
    REQUIRE(world.robots().size() <= 4);
    for (const auto& robot : world.robots()) {
      REQUIRE(
          std::isfinite(robot.x_m() + robot.y_m() + robot.vx_mps() + robot.vy_mps() + robot.heading_rad()));
      REQUIRE(std::isfinite(robot.angular_radps() + robot.observed_x_m() + robot.observed_y_m()));
      REQUIRE(robot.position_variance_m2() > 0);
      REQUIRE(robot.velocity_variance_m2ps2() > 0);
    }
    const auto& ball = world.ball();
    if (ball.is_visible()) REQUIRE(std::isfinite(ball.x_m() + ball.y_m() + ball.vx_mps() + ball.vy_mps()));
  }
  CHECK(fixture.rejected() > 0);
}

}  // namespace sidestep::tracker_order_test
