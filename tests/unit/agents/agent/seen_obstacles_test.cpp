// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/seen_obstacles.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace sidestep;

namespace {

constexpr Duration kSlack{1'000'000};
constexpr double kSpeed_mps = 1.5;

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

struct Eyes {
  SeenObstacles seen{kSpeed_mps, kSlack};

  static msg::WorldState world(std::uint32_t track, double x, double seen_at, std::uint64_t vision = 1) {
    msg::WorldState state;
    state.head().incarnation(vision);
    add(state, track, x, seen_at);
    return state;
  }
  static void add(msg::WorldState& state, std::uint32_t track, double x, double seen_at) {
    msg::TrackedObstacle& obstacle = state.obstacles()[state.obstacle_count()];
    state.obstacle_count(static_cast<std::uint8_t>(state.obstacle_count() + 1));
    obstacle.obstacle(track);
    obstacle.seen_at_ns(to_ns(at_s(seen_at)));
    obstacle.x_m(x);
    obstacle.radius_m(0.1);
    obstacle.position_variance_m2(0.0001);
  }
};

}  // namespace

TEST_CASE("a sight is remembered with what it is uncertain by, until a newer one of the same track comes") {
  Eyes eyes;
  eyes.seen.on_world(Eyes::world(5, 1, 10), at_s(10.02));
  REQUIRE(eyes.seen.recent(at_s(10.02)).size() == 1);
  const MovingObstacle first = eyes.seen.recent(at_s(10.02))[0];
  CHECK(first.position_m == Vec2(1, 0));
  CHECK(first.radius_m == Approx(0.1 + 4 * 0.01));
  CHECK(first.speed_mps == kSpeed_mps);
  CHECK(first.seen_at == at_s(10) - kSlack);
  eyes.seen.on_world(Eyes::world(5, 1.2, 10.1), at_s(10.12));
  // A late message.
  eyes.seen.on_world(Eyes::world(5, 1.1, 10.05), at_s(10.13));
  REQUIRE(eyes.seen.recent(at_s(10.13)).size() == 1);
  CHECK(eyes.seen.recent(at_s(10.13))[0].position_m == Vec2(1.2, 0));
}

TEST_CASE("what is not seen any more stays for a second, and grows") {
  Eyes eyes;
  eyes.seen.on_world(Eyes::world(5, 1, 10), at_s(10.02));
  eyes.seen.on_world(msg::WorldState(), at_s(10.5));
  REQUIRE(eyes.seen.recent(at_s(10.9)).size() == 1);
  CHECK(eyes.seen.recent(at_s(10.9))[0].reach_m(at_s(10.9)) == Approx(0.14 + 0.9 * kSpeed_mps).margin(0.01));
  CHECK(eyes.seen.recent(at_s(11.1)).empty());
}

TEST_CASE("a vision that started again counts its tracks anew, and does not replace what the old one saw") {
  Eyes eyes;
  eyes.seen.on_world(Eyes::world(1, 1, 10, 1), at_s(10.02));
  eyes.seen.on_world(Eyes::world(1, -1, 10.1, 2), at_s(10.12));
  CHECK(eyes.seen.recent(at_s(10.2)).size() == 2);
}

TEST_CASE("sights that cannot be are counted and dropped, and the others of the message still count") {
  Eyes eyes;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refuse = [&](auto spoil) {
    const auto before = eyes.seen.invalid();
    msg::WorldState state = Eyes::world(5, 1, 10);
    spoil(state.obstacles()[0]);
    Eyes::add(state, 6, 2, 10);
    eyes.seen.on_world(state, at_s(10.02));
    CHECK(eyes.seen.invalid() == before + 1);
    REQUIRE(eyes.seen.recent(at_s(10.02)).size() == 1);
    CHECK(eyes.seen.recent(at_s(10.02))[0].position_m == Vec2(2, 0));
  };
  refuse([](msg::TrackedObstacle& o) { o.x_m(kNan); });
  refuse([](msg::TrackedObstacle& o) { o.y_m(1e300); });
  refuse([](msg::TrackedObstacle& o) { o.radius_m(-0.1); });
  refuse([](msg::TrackedObstacle& o) { o.radius_m(kNan); });
  refuse([](msg::TrackedObstacle& o) { o.position_variance_m2(-1); });
  refuse([](msg::TrackedObstacle& o) { o.position_variance_m2(kNan); });
  refuse([](msg::TrackedObstacle& o) { o.seen_at_ns(to_ns(at_s(10.03))); });
  refuse([](msg::TrackedObstacle& o) { o.seen_at_ns(std::numeric_limits<std::int64_t>::max()); });
  msg::WorldState state = Eyes::world(7, 1, 10);
  state.obstacle_count(msg::MAX_OBSTACLES + 1);
  eyes.seen.on_world(state, at_s(10.02));
  CHECK(eyes.seen.recent(at_s(10.02)).size() == 1);
  state = Eyes::world(7, 1, 10);
  state.obstacles()[0].seen_at_ns(std::numeric_limits<std::int64_t>::min());
  eyes.seen.on_world(state, at_s(10.02));
  CHECK(eyes.seen.recent(at_s(10.02)).size() == 1);
}

TEST_CASE("with more tracks than there is room for the oldest sights go") {
  Eyes eyes;
  for (std::uint32_t track = 0; track < 3 * SeenObstacles::kMost; ++track) {
    const double seen_at = 10 + 0.001 * track;
    eyes.seen.on_world(Eyes::world(track, track, seen_at), at_s(seen_at + 0.001));
  }
  const auto recent = eyes.seen.recent(at_s(10.1));
  REQUIRE(recent.size() == SeenObstacles::kMost);
  for (const MovingObstacle& obstacle : recent) CHECK(obstacle.position_m.x() >= 2 * SeenObstacles::kMost);
}
