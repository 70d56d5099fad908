// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/observed_obstacles.hpp"

#include "tests/catch.hpp"

namespace sidestep::observed_obstacles_test {

constexpr Duration kSlack{1'000'000};
constexpr double kSpeed_mps = 1.5;

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

struct Fixture {
  ObservedObstacles obstacles{kSpeed_mps, kSlack};

  static WorldObservations world(std::uint32_t track, double x, double observed_at, Incarnation vision = 1) {
    WorldObservations observations;
    observations.vision = vision;
    add(observations, track, x, observed_at);
    return observations;
  }
  static void add(WorldObservations& observations, std::uint32_t track, double x, double observed_at) {
    observations.obstacles[observations.obstacle_count++] = {track, at_s(observed_at), {x, 0}, 0.1, 0.0001};
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
  f.obstacles.on_world(WorldObservations(), at_s(10.5));
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

TEST_CASE("observations from the future are counted and dropped, and the others are still used") {
  Fixture f;
  const Time now = at_s(10.02);
  for (const Time observed_at : {at_s(10.03), Time::max()}) {
    const auto before = f.obstacles.invalid();
    WorldObservations world = Fixture::world(5, 1, 10);
    world.obstacles[0].observed_at = observed_at;
    Fixture::add(world, 6, 2, 10);
    f.obstacles.on_world(world, now);
    CHECK(f.obstacles.invalid() == before + 1);
    REQUIRE(f.obstacles.recent(now).size() == 1);
    CHECK(f.obstacles.recent(now)[0].position_m == Vec2(2, 0));
  }
}

TEST_CASE("old observations are dropped, and not counted as invalid") {
  Fixture f;
  WorldObservations world = Fixture::world(7, 1, 10);
  for (const Time observed_at : {at_s(9), Time::min()}) {
    world.obstacles[0].observed_at = observed_at;
    f.obstacles.on_world(world, at_s(10.02));
    CHECK(f.obstacles.recent(at_s(10.02)).empty());
  }
  CHECK(f.obstacles.invalid() == 0);
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
