// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/observed_obstacles.hpp"

#include <algorithm>
#include <limits>

#include "common/protocol/obstacle_bounds.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::observed_obstacles_test {

constexpr Duration kSlack{1'000'000};
constexpr Duration kNoLag{0};
constexpr double kSpeed_mps = 1.5;

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

/// A list and its obstacles.
struct List {
  std::vector<ObservedObstacle> obstacles;
  ObstacleObservations observations;

  explicit List(double valid_at, Incarnation vision = 1)
      : observations{vision, at_s(valid_at), kCompleteEverywhere_m, {}} {}
  List& add(std::uint32_t track, const Vec2& position_m, Time observed_at) {
    obstacles.push_back({track, observed_at, position_m, 0.1, 0.0001});
    return *this;
  }
  List& add(std::uint32_t track, double x, double observed_at) {
    return add(track, {x, 0}, at_s(observed_at));
  }
  operator ObstacleObservations() const {
    ObstacleObservations result = observations;
    result.obstacles = obstacles;
    return result;
  }
};

struct Fixture {
  ObservedObstacles obstacles{kSpeed_mps, kSlack};

  /// Delivers a list to a robot at the origin.
  void receive(const List& list, double now) { obstacles.on_list(list, {0, 0}, at_s(now)); }
  void receive(std::uint32_t track, double x, double observed_at, double now, Incarnation vision = 1) {
    receive(List(observed_at, vision).add(track, x, observed_at), now);
  }
};

TEST_CASE("an observation is kept with its uncertainty until a newer one of the same track arrives") {
  Fixture f;
  f.receive(5, 1, 10, 10.02);
  REQUIRE(f.obstacles.recent(at_s(10.02), kNoLag).size() == 1);
  const MovingObstacle first = f.obstacles.recent(at_s(10.02), kNoLag)[0];
  CHECK(first.position_m == Vec2(1, 0));
  CHECK(first.radius_m == Approx(0.1 + 4 * 0.01));
  CHECK(first.speed_mps == kSpeed_mps);
  CHECK(first.observed_at == at_s(10) - kSlack);
  f.receive(5, 1.2, 10.1, 10.12);
  // This message arrives late.
  f.receive(5, 1.1, 10.05, 10.13);
  REQUIRE(f.obstacles.recent(at_s(10.13), kNoLag).size() == 1);
  CHECK(f.obstacles.recent(at_s(10.13), kNoLag)[0].position_m == Vec2(1.2, 0));
}

TEST_CASE("an unobserved obstacle is kept for a second, and its reach grows") {
  Fixture f;
  f.receive(5, 1, 10, 10.02);
  f.receive(List(10.5), 10.5);
  REQUIRE(f.obstacles.recent(at_s(10.9), kNoLag).size() == 1);
  CHECK(f.obstacles.recent(at_s(10.9), kNoLag)[0].reach_m(at_s(10.9)) ==
        Approx(0.14 + 0.9 * kSpeed_mps).margin(0.01));
  CHECK(f.obstacles.recent(at_s(11.1), kNoLag).empty());
}

TEST_CASE("tracks of a restarted vision process do not replace those of its predecessor") {
  Fixture f;
  f.receive(1, 1, 10, 10.02, 1);
  f.receive(1, -1, 10.1, 10.12, 2);
  CHECK(f.obstacles.recent(at_s(10.2), kNoLag).size() == 2);
}

TEST_CASE("the latest observation of every track is kept, in any order of tracks and lists") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  Fixture f;
  std::vector<Time> latest(100);
  for (int i = 0; i < 300; ++i) {
    List list(10);
    for (std::uint64_t left = rng.below(50); left > 0; --left) {
      const auto track = static_cast<std::uint32_t>(rng.below(100));
      const Time observed_at = at_s(rng.uniform(9.5, 10));
      list.add(track, {static_cast<double>(track), to_seconds(observed_at - at_s(9))}, observed_at);
      latest[track] = std::max(latest[track], observed_at);
    }
    f.receive(list, 10);
  }
  const auto recent = f.obstacles.recent(at_s(10), kNoLag);
  CHECK(recent.size() ==
        static_cast<std::size_t>(std::ranges::count_if(latest, [](Time t) { return t != Time{}; })));
  for (const MovingObstacle& obstacle : recent) {
    const Time expected = latest.at(static_cast<std::size_t>(obstacle.position_m.x()));
    REQUIRE(obstacle.observed_at == expected - kSlack);
    REQUIRE(obstacle.position_m.y() == to_seconds(expected - at_s(9)));
  }
}

TEST_CASE("an observation from the future is counted and dropped, and its list does not count as complete") {
  const Time now = at_s(10.02);
  for (const Time observed_at : {at_s(10.03), Time::max()}) {
    Fixture f;
    f.receive(List(10).add(5, {1, 0}, observed_at).add(6, 2, 10), 10.02);
    CHECK(f.obstacles.invalid() == 1);
    REQUIRE(f.obstacles.recent(now, kNoLag).size() == 1);
    CHECK(f.obstacles.recent(now, kNoLag)[0].position_m == Vec2(2, 0));
    CHECK(f.obstacles.complete_at() == Time{});
  }
}

TEST_CASE("a list from the future is counted and dropped as a whole") {
  for (const Time valid_at : {at_s(10.2), Time::max()}) {
    Fixture f;
    List list(0);
    list.observations.valid_at = valid_at;
    f.receive(list.add(5, 1, 10), 10.02);
    CHECK(f.obstacles.invalid() == 1);
    CHECK(f.obstacles.recent(at_s(10.02), kNoLag).empty());
    CHECK(f.obstacles.complete_at() == Time{});
    // Vision's clock only needs to be roughly right.
    f.receive(List(10.1), 10.02);
    CHECK(f.obstacles.invalid() == 1);
    CHECK(f.obstacles.complete_at() == at_s(10.1));
  }
}

TEST_CASE("a list may be ahead by the clock bound plus the tolerance for vision's clock") {
  const Duration max_difference{150'000'000};
  ObservedObstacles obstacles(kSpeed_mps, max_difference);
  obstacles.on_list(List(10.26), {0, 0}, at_s(10));
  CHECK(obstacles.complete_at() == Time{});
  obstacles.on_list(List(10.24), {0, 0}, at_s(10));
  CHECK(obstacles.complete_at() == at_s(10.24));
}

TEST_CASE("old observations are dropped but not counted as invalid") {
  for (const Time observed_at : {at_s(9), Time::min()}) {
    Fixture f;
    f.receive(List(10).add(7, {1, 0}, observed_at), 10.02);
    CHECK(f.obstacles.recent(at_s(10.02), kNoLag).empty());
    CHECK(f.obstacles.invalid() == 0);
    CHECK(f.obstacles.complete_at() == at_s(10));
  }
}

TEST_CASE("beyond the capacity, the farthest obstacles are forgotten and all nearer obstacles are kept") {
  const std::uint64_t seed = GENERATE(range(1u, 11u));
  CAPTURE(seed);
  Rng rng(seed);
  Fixture f;
  std::vector<MovingObstacle> all;
  const std::uint32_t count = 2 * ObservedObstacles::kCapacity;
  for (std::uint32_t track = 0; track < count; ++track) {
    const double x = rng.uniform(-5, 5), y = rng.uniform(-5, 5), observed_at = 10 + 0.0001 * track;
    f.receive(List(observed_at).add(track, {x, y}, at_s(observed_at)), observed_at + 0.001);
    all.push_back({{x, y}, 0.14, at_s(observed_at) - kSlack, kSpeed_mps});
  }
  const Time now = at_s(10.15);
  const auto recent = f.obstacles.recent(now, kNoLag);
  REQUIRE(recent.size() == ObservedObstacles::kCapacity);
  const SeenRegion seen = f.obstacles.seen(now, kNoLag);
  REQUIRE_FALSE(seen.is_everywhere());
  CHECK(seen.radius_at_m(now) > 2);
  for (const MovingObstacle& obstacle : all) {
    const auto is_same = [&](const MovingObstacle& known) { return known.position_m == obstacle.position_m; };
    if (std::ranges::any_of(recent, is_same)) continue;
    const double distance = (obstacle.position_m - seen.centre_m).norm();
    for (const double later_s : {0.0, 0.1, 0.5})
      REQUIRE(distance - obstacle.reach_m(now + from_seconds(later_s)) >=
              seen.radius_at_m(now + from_seconds(later_s)) - 1e-9);
  }
  // By now, the forgotten obstacles would have been dropped anyway.
  CHECK(f.obstacles.seen(now + from_seconds(1.2), kNoLag).is_everywhere());
}

TEST_CASE(
    "observations accepted while the clock was ahead are forgotten, and lists are used again a second "
    "later") {
  Fixture f;
  f.receive(5, 1, 3600, 3600.02);
  REQUIRE(f.obstacles.complete_at() == at_s(3600));
  // From now on, the clocks are correct.
  f.receive(List(10).add(6, 2, 10), 10.02);
  CHECK(f.obstacles.complete_at() == Time{});
  REQUIRE(f.obstacles.recent(at_s(10.02), kNoLag).size() == 1);
  CHECK(f.obstacles.recent(at_s(10.02), kNoLag)[0].position_m == Vec2(2, 0));
  f.receive(List(11).add(6, 2, 11), 11.01);
  CHECK(f.obstacles.complete_at() == Time{});
  f.receive(List(11.03).add(6, 2, 11.03), 11.05);
  CHECK(f.obstacles.complete_at() == at_s(11.03));
  // The clock is ahead again before lists are used.
  f.receive(5, 1, 3600, 3600.02);
  f.receive(List(12).add(6, 2, 12), 12.02);
  f.receive(5, 1, 3600, 3600.02);
  f.receive(List(12.5).add(6, 2, 12.5), 12.52);
  f.receive(List(13.6).add(6, 2, 13.6), 13.62);
  CHECK(f.obstacles.complete_at() == at_s(13.6));
}

}  // namespace sidestep::observed_obstacles_test
