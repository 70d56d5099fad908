// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/safety_search.hpp"

#include <catch2/catch.hpp>

#include "common/motion/clearance.hpp"
#include "common/motion/robot_model.hpp"

using namespace sidestep;

namespace {

const Time kStart = time_from_ns(5'000'000'000);
constexpr Duration kCycle{16'666'667};

Version moving_robot(RobotId id, Vec2 position, Vec2 velocity) {
  Trajectory trajectory(kStart - Duration{8'000'000}, {position, velocity});
  append_stop(trajectory, 5);
  return {id, 1, id + 100u, 0, trajectory};
}

}  // namespace

TEST_CASE("with nobody near, the wish itself is the first candidate") {
  SafetySearch search({}, {});
  Rng rng(1);
  const auto result = search.search({kStart, {{0, 0}, {1, 0}}, {2, 1}, kCycle}, {}, rng);
  REQUIRE(result.count == SearchResult::kMaxCandidates);
  CHECK((result.candidates[0].phases()[0].acceleration_mps2 - Vec2(2, 1)).norm() < 1e-12);
}

TEST_CASE(
    "every candidate is clear of everybody, within the limits, and the nearest to the wish comes first") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  FloorRules rules;
  rules.field = {6, 6};
  rules.obstacles = {{{0.5, 0.5}, 0.1}, {{-0.6, 0.2}, 0.15}};
  SafetySearch search(rules, {});
  std::size_t found = 0, blocked = 0;
  for (int scene = 0; scene < 3000; ++scene) {
    std::vector<Version> others;
    for (RobotId id = 1; id <= 6; ++id) {
      others.push_back(moving_robot(id, {rng.uniform(-0.8, 0.8), rng.uniform(-0.8, 0.8)},
                                    rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3, 3))));
    }
    const Vec2 velocity = rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3, 3));
    const Vec2 wish = 5 * Vec2(rng.uniform(-1, 1), rng.uniform(-1, 1));
    const auto result = search.search({kStart, {{0, 0}, velocity}, wish, kCycle}, others, rng);
    ++(result.count ? found : blocked);
    const Vec2 reachable = limited(wish, velocity, rules.limits, kCycle);
    double last = -1;
    for (std::size_t i = 0; i < result.count; ++i) {
      const Trajectory& candidate = result.candidates[i];
      REQUIRE(check_limits(candidate, rules.limits) == msg::REASON_GRANTED);
      REQUIRE(check_place(candidate, rules) == msg::REASON_GRANTED);
      for (const Version& other : others)
        REQUIRE(clearance_m(candidate, other.trajectory, rules.keep_m()) >= 0);
      const double distance = (candidate.phases()[0].acceleration_mps2 - reachable).norm();
      REQUIRE(distance >= last);
      last = distance;
    }
  }
  CHECK(found > 500);
  CHECK(blocked > 100);
}

TEST_CASE("the same seed gives the same candidates") {
  SafetySearch one({}, {}), two({}, {});
  Rng rng_one(9), rng_two(9);
  for (int i = 0; i < 20; ++i) {
    const SearchQuery query{kStart, {{0, 0}, {0.1 * i, 0}}, {1, 1}, kCycle};
    const auto a = one.search(query, {}, rng_one), b = two.search(query, {}, rng_two);
    REQUIRE(a.count == b.count);
    for (std::size_t k = 0; k < a.count; ++k) {
      REQUIRE(a.candidates[k].phases()[0].acceleration_mps2 == b.candidates[k].phases()[0].acceleration_mps2);
    }
  }
}

TEST_CASE("whatever moves without asking, every candidate is at rest before it could be there") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  FloorRules rules;
  rules.field = {6, 6};
  SafetySearch search(rules, {});
  std::size_t found = 0, blocked = 0, refused = 0;
  for (int scene = 0; scene < 1000; ++scene) {
    std::vector<MovingObstacle> moving;
    for (int i = 0; i < 3; ++i) {
      moving.push_back({{rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5)},
                        0.09,
                        kStart - from_seconds(rng.uniform(0, 0.05)),
                        1.5});
    }
    const Vec2 velocity = rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3, 3));
    SearchQuery query{kStart, {{0, 0}, velocity}, 3 * rotated({1, 0}, rng.uniform(-3, 3)), kCycle};
    Rng again = rng;
    const std::size_t without = search.search(query, {}, again).count;
    query.moving = moving;
    const auto result = search.search(query, {}, rng);
    ++(result.count ? found : blocked);
    refused += result.count < without;
    for (std::size_t i = 0; i < result.count; ++i) {
      const Trajectory& candidate = result.candidates[i];
      // By dense sampling.
      for (const MovingObstacle& obstacle : moving) {
        for (Time t = candidate.start(); t < candidate.end(); t += Duration{500'000}) {
          const double distance = (candidate.state_at(t).position_m - obstacle.position_m).norm();
          REQUIRE(distance > rules.radius_m + rules.margin_m + obstacle.reach_m(t));
        }
      }
    }
  }
  CHECK(found > 100);
  CHECK(blocked > 100);
  CHECK(refused > 100);
}
