// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/obstacle_list_decoder.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "common/messaging/topics.hpp"
#include "common/messaging/version_codec.hpp"
#include "common/protocol/obstacle_bounds.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::obstacle_list_decoder_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void add_obstacle(msg::ObstacleList& list, std::uint32_t track, double x) {
  msg::TrackedObstacle& obstacle = list.obstacles().emplace_back();
  obstacle.obstacle(track);
  obstacle.observed_at_ns(2000 + track);
  obstacle.x_m(x);
  obstacle.y_m(-x);
  obstacle.radius_m(0.1);
  obstacle.position_variance_m2(0.0001);
}

msg::ObstacleList valid_list() {
  msg::ObstacleList list;
  list.header().sender(20000);
  list.header().incarnation(9);
  list.valid_at_ns(3000);
  list.complete_within_m(1.5);
  add_obstacle(list, 5, 1);
  add_obstacle(list, 6, 2);
  return list;
}

TEST_CASE("an obstacle list is decoded unchanged") {
  ObstacleListDecoder decoder;
  const auto list = decoder.decode(valid_list());
  REQUIRE(list);
  CHECK(list->vision == 9);
  CHECK(list->valid_at == time_from_ns(3000));
  CHECK(list->complete_within_m == 1.5);
  REQUIRE(list->obstacles.size() == 2);
  CHECK(list->obstacles[0].track == 5);
  CHECK(list->obstacles[0].observed_at == time_from_ns(2005));
  CHECK(list->obstacles[0].position_m == Vec2(1, -1));
  CHECK(list->obstacles[0].radius_m == 0.1);
  CHECK(list->obstacles[0].position_variance_m2 == 0.0001);
  CHECK(list->obstacles[1].track == 6);
  msg::ObstacleList empty = valid_list();
  empty.obstacles().clear();
  empty.complete_within_m(kCompleteEverywhere_m);
  REQUIRE(decoder.decode(empty));
  CHECK(decoder.decode(empty)->obstacles.empty());
}

TEST_CASE("a list with an impossible number is refused as a whole, because the rest would not be complete") {
  ObstacleListDecoder decoder;
  const auto is_refused = [&](auto spoil) {
    msg::ObstacleList list = valid_list();
    spoil(list, list.obstacles()[1]);
    return !decoder.decode(list);
  };
  using List = msg::ObstacleList;
  using Obstacle = msg::TrackedObstacle;
  CHECK_FALSE(is_refused([](List&, Obstacle&) {}));
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e300, -1e300}) {
    CAPTURE(bad);
    CHECK(is_refused([=](List&, Obstacle& o) { o.x_m(bad); }));
    CHECK(is_refused([=](List&, Obstacle& o) { o.y_m(bad); }));
    CHECK(is_refused([=](List&, Obstacle& o) { o.radius_m(bad); }));
    CHECK(is_refused([=](List&, Obstacle& o) { o.position_variance_m2(bad); }));
    CHECK(is_refused([=](List& l, Obstacle&) { l.complete_within_m(bad); }));
  }
  // Numbers exactly at the bounds are accepted.
  for (const double sign : {-1.0, 1.0}) {
    for (const double m : {kMaxCoordinate_m, 1.001 * kMaxCoordinate_m}) {
      CHECK(is_refused([=](List&, Obstacle& o) { o.x_m(sign * m); }) == (m > kMaxCoordinate_m));
      CHECK(is_refused([=](List&, Obstacle& o) { o.y_m(sign * m); }) == (m > kMaxCoordinate_m));
    }
  }
  CHECK(is_refused([](List&, Obstacle& o) { o.radius_m(-0.1); }));
  CHECK(is_refused([](List&, Obstacle& o) { o.position_variance_m2(-1); }));
  CHECK(is_refused([](List& l, Obstacle&) { l.complete_within_m(-0.1); }));
  CHECK(is_refused([](List& l, Obstacle&) { l.obstacles().resize(msg::MAX_OBSTACLES + 1); }));
  CHECK_FALSE(is_refused([](List& l, Obstacle&) { l.obstacles().resize(msg::MAX_OBSTACLES); }));
}

TEST_CASE("a list with random bytes is refused or within bounds") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  ObstacleListDecoder decoder;
  int accepted = 0, refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    const msg::ObstacleList original = valid_list();
    std::vector<std::uint8_t> bytes;
    append_cdr(topics::kObstacles, &original, bytes);
    for (std::uint64_t changes = 1 + rng.below(3); changes > 0; --changes) {
      if (rng.chance(0.5)) {
        bytes[rng.below(bytes.size())] = static_cast<std::uint8_t>(rng.bits());
        continue;
      }
      // Eight-byte numbers are aligned.
      const double bad[] = {kNan, kInfinity, -kInfinity, 1e300, -1.0, 1e9};
      const auto word = std::bit_cast<std::uint64_t>(bad[rng.below(6)]);
      const std::uint64_t begin = 8 * rng.below(bytes.size() / 8);
      for (std::size_t k = 0; k < 8; ++k) bytes[begin + k] = static_cast<std::uint8_t>(word >> (8 * k));
    }
    const auto check = [&](const void* message) {
      const auto list = decoder.decode(*static_cast<const msg::ObstacleList*>(message));
      ++(list ? accepted : refused);
      if (!list) return;
      bool is_valid = list->complete_within_m >= 0 && list->complete_within_m <= kCompleteEverywhere_m;
      for (const ObservedObstacle& o : list->obstacles) {
        is_valid = is_valid && o.position_m.cwiseAbs().maxCoeff() <= 1e4 && o.radius_m >= 0 &&
                   o.radius_m <= 10 && o.position_variance_m2 >= 0 && o.position_variance_m2 <= 10;
      }
      if (!is_valid) FAIL("list " << i << " is out of bounds");
    };
    (void)read_cdr(topics::kObstacles, bytes, check);
  }
  CHECK(accepted > 1000);
  CHECK(refused > 1000);
}

}  // namespace sidestep::obstacle_list_decoder_test
