// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/observed_obstacles.hpp"

#include <catch2/catch.hpp>
#include <limits>

namespace sidestep::observed_obstacles_test {

constexpr Duration kSlack{1'000'000};
constexpr double kSpeed_mps = 1.5;

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

struct Fixture {
  ObservedObstacles obstacles{kSpeed_mps, kSlack};

  static msg::WorldState world(std::uint32_t track, double x, double observed_at, std::uint64_t vision = 1) {
    msg::WorldState state;
    state.header().incarnation(vision);
    add(state, track, x, observed_at);
    return state;
  }
  static void add(msg::WorldState& state, std::uint32_t track, double x, double observed_at) {
    msg::TrackedObstacle& obstacle = state.obstacles()[state.obstacle_count()];
    state.obstacle_count(static_cast<std::uint8_t>(state.obstacle_count() + 1));
    obstacle.obstacle(track);
    obstacle.observed_at_ns(to_ns(at_s(observed_at)));
    obstacle.x_m(x);
    obstacle.radius_m(0.1);
    obstacle.position_variance_m2(0.0001);
  }
};

TEST_CASE("an observation is kept with its uncertainty until a newer one of the same track arrives") {
  Fixture f;
  f.obstacles.on_world(Fixture::world(5, 1, 10), at_s(10.02));
  REQUIRE(f.obstacles.recent(at_s(10.02)).size() == 1);
  const MovingObstacle first = f.obstacles.recent(at_s(10.02))[0];
  CHECK(first.position_m == Vec2(1, 0));
  CHECK(first.radius_m == Approx(0.1 + 4 * 0.01));
  CHECK(first.speed_mps == kSpeed_mps);
  CHECK(first.observed_at == at_s(10) - kSlack);
  f.obstacles.on_world(Fixture::world(5, 1.2, 10.1), at_s(10.12));
  // A late message.
  f.obstacles.on_world(Fixture::world(5, 1.1, 10.05), at_s(10.13));
  REQUIRE(f.obstacles.recent(at_s(10.13)).size() == 1);
  CHECK(f.obstacles.recent(at_s(10.13))[0].position_m == Vec2(1.2, 0));
}

TEST_CASE("an obstacle that is no longer observed is kept for a second, and its reach grows") {
  Fixture f;
  f.obstacles.on_world(Fixture::world(5, 1, 10), at_s(10.02));
  f.obstacles.on_world(msg::WorldState(), at_s(10.5));
  REQUIRE(f.obstacles.recent(at_s(10.9)).size() == 1);
  CHECK(f.obstacles.recent(at_s(10.9))[0].reach_m(at_s(10.9)) ==
        Approx(0.14 + 0.9 * kSpeed_mps).margin(0.01));
  CHECK(f.obstacles.recent(at_s(11.1)).empty());
}

TEST_CASE("tracks of a restarted vision process do not replace those of its predecessor") {
  Fixture f;
  f.obstacles.on_world(Fixture::world(1, 1, 10, 1), at_s(10.02));
  f.obstacles.on_world(Fixture::world(1, -1, 10.1, 2), at_s(10.12));
  CHECK(f.obstacles.recent(at_s(10.2)).size() == 2);
}

TEST_CASE("impossible observations are counted and dropped, and the rest of the message is still used") {
  Fixture f;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto check_refused = [&](auto spoil) {
    const auto before = f.obstacles.invalid();
    msg::WorldState state = Fixture::world(5, 1, 10);
    spoil(state.obstacles()[0]);
    Fixture::add(state, 6, 2, 10);
    f.obstacles.on_world(state, at_s(10.02));
    CHECK(f.obstacles.invalid() == before + 1);
    REQUIRE(f.obstacles.recent(at_s(10.02)).size() == 1);
    CHECK(f.obstacles.recent(at_s(10.02))[0].position_m == Vec2(2, 0));
  };
  check_refused([](msg::TrackedObstacle& o) { o.x_m(kNan); });
  check_refused([](msg::TrackedObstacle& o) { o.y_m(1e300); });
  check_refused([](msg::TrackedObstacle& o) { o.radius_m(-0.1); });
  check_refused([](msg::TrackedObstacle& o) { o.radius_m(kNan); });
  check_refused([](msg::TrackedObstacle& o) { o.position_variance_m2(-1); });
  check_refused([](msg::TrackedObstacle& o) { o.position_variance_m2(kNan); });
  check_refused([](msg::TrackedObstacle& o) { o.observed_at_ns(to_ns(at_s(10.03))); });
  check_refused([](msg::TrackedObstacle& o) { o.observed_at_ns(std::numeric_limits<std::int64_t>::max()); });
  msg::WorldState state = Fixture::world(7, 1, 10);
  state.obstacle_count(msg::MAX_OBSTACLES + 1);
  f.obstacles.on_world(state, at_s(10.02));
  CHECK(f.obstacles.recent(at_s(10.02)).size() == 1);
  state = Fixture::world(7, 1, 10);
  state.obstacles()[0].observed_at_ns(std::numeric_limits<std::int64_t>::min());
  f.obstacles.on_world(state, at_s(10.02));
  CHECK(f.obstacles.recent(at_s(10.02)).size() == 1);
}

TEST_CASE("beyond the capacity, the oldest observations are dropped") {
  Fixture f;
  for (std::uint32_t track = 0; track < 3 * ObservedObstacles::kCapacity; ++track) {
    const double observed_at = 10 + 0.001 * track;
    f.obstacles.on_world(Fixture::world(track, track, observed_at), at_s(observed_at + 0.001));
  }
  const auto recent = f.obstacles.recent(at_s(10.1));
  REQUIRE(recent.size() == ObservedObstacles::kCapacity);
  for (const MovingObstacle& obstacle : recent)
    CHECK(obstacle.position_m.x() >= 2 * ObservedObstacles::kCapacity);
}

}  // namespace sidestep::observed_obstacles_test
