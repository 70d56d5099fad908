// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/give_way_search.hpp"

#include "tests/catch.hpp"

namespace sidestep::give_way_search_test {

constexpr double kRadius_m = 0.09, kRequired_m = 0.104, kSeparation_m = 0.194;
const GiveWayFloor kFloor{{10, 4}, kRadius_m, kRequired_m, kSeparation_m};

/// A corridor along the x axis that is 0.3 m wide, with a bay of random position, width and depth on one
/// side.
struct Corridor {
  double bay_x_m, half_width_m, depth_m;
  ObstacleWorld world;

  explicit Corridor(Rng& rng)
      : bay_x_m(rng.uniform(-3.5, -0.5)),
        half_width_m(rng.uniform(0.2, 0.5)),
        depth_m(rng.uniform(0.3, 0.8)) {
    const double top_m = 0.15 + depth_m, left_m = bay_x_m - half_width_m, right_m = bay_x_m + half_width_m;
    world = ObstacleWorld({Box{{-5, -2}, {5, -0.15}}, Box{{-5, 0.15}, {left_m, 2}},
                           Box{{right_m, 0.15}, {5, 2}}, Box{{left_m, top_m}, {right_m, 2}}});
  }
  /// Brute force: the nearest place on a fine grid that is far enough from the other robot's centre line.
  double nearest_m() const {
    double best_m = 1e9;
    for (double x = -4; x < 0; x += 0.01)
      for (double y = 0; y < 1.2; y += 0.01)
        if (y >= kSeparation_m + 0.02 && !world.touches({x, y}, kRequired_m))
          best_m = std::min(best_m, std::hypot(x, y));
    return best_m;
  }
};

int finish(GiveWaySearch& search, Rng& rng) {
  int steps = 0;
  for (; search.is_active(); ++steps) search.step(rng);
  return steps;
}

TEST_CASE("the search for the nearest place to give way agrees with a brute-force search") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Corridor corridor(rng);
    GiveWaySearch search(kFloor);
    // The other robot drives along the middle of the corridor.
    search.begin({{0, 0}, {{{0.2, 0}, {-4.8, 0}}}, {{0.2, 0}}, {}, 8}, corridor.world);
    finish(search, rng);
    REQUIRE(search.is_in_the_way());
    REQUIRE(search.way().size() >= 2);
    const Vec2 place = search.way().back();
    CHECK_FALSE(corridor.world.touches(place, kRequired_m));
    // The tolerances allow for the resolution of the brute-force grid and of the search's coarser cells.
    CHECK(place.norm() >= corridor.nearest_m() - 0.01);
    CHECK(place.norm() <= corridor.nearest_m() + 3 * kRadius_m);
    for (std::size_t i = 1; i < search.way().size(); ++i)
      CHECK_FALSE(corridor.world.touches(search.way()[i - 1], search.way()[i], kRequired_m - 1e-9));
  }
}

TEST_CASE("a search for a place that does not exist takes many steps but ends") {
  const ObstacleWorld corridor({Box{{-5, -2}, {5, -0.15}}, Box{{-5, 0.15}, {5, 2}}});
  Rng rng(1);
  GiveWaySearch search(kFloor);
  search.begin({{0, 0}, {{{0.2, 0}, {-4.8, 0}}}, {{0.2, 0}}, {}, 8}, corridor);
  const double rings = 8 / (GiveWaySearch::kGridFraction * kRadius_m);
  CHECK(finish(search, rng) >= 4 * rings * rings / GiveWaySearch::kMaxPlaces);
  CHECK(search.is_in_the_way());
  CHECK(search.way().empty());
}

TEST_CASE("a robot on its way to a bay is in the way until the other robot has passed") {
  Rng rng(1);
  const ObstacleWorld open;
  GiveWaySearch search(kFloor);
  const std::vector<Vec2> way{{0, 0}, {-1, 0}, {-1, 0.4}};
  search.begin({{-1, 0.4}, {{{0.5, 0}, {-4, 0}}}, {}, way, 1}, open);
  finish(search, rng);
  CHECK(search.is_in_the_way());
  search.begin({{-1, 0.4}, {{{-1.3, 0}, {-4, 0}}}, {}, way, 1}, open);
  finish(search, rng);
  CHECK_FALSE(search.is_in_the_way());
  search.begin({{0, 0}, {{{0.5, 0}, {-4, 0}}}, {}, {}, 1}, open);
  finish(search, rng);
  CHECK_FALSE(search.is_in_the_way());  // the other robot can go around
}

TEST_CASE(
    "an idle robot comes back when the place that it left is off the route of another one that comes back") {
  Rng rng(1);
  const ObstacleWorld corridor({Box{{-2, -2}, {2, -0.15}}, Box{{-2, 0.15}, {2, 2}}});
  GiveWaySearch search(kFloor);
  const std::vector<Vec2> way{{0.5, 0}, {2.5, 0}, {2.5, 0.5}};
  const auto is_in_the_way = [&](const Vec2& other_goal_m) {
    GiveWayQuery query{way.back(), {}, {}, way, 1};
    query.returns.push_back({{2.5, -0.5}, other_goal_m});
    search.begin(query, corridor);
    finish(search, rng);
    return search.is_in_the_way();
  };
  CHECK(is_in_the_way({-0.5, 0}));  // the other one goes deeper into the corridor
  CHECK_FALSE(is_in_the_way({1.2, 0}));
}

}  // namespace sidestep::give_way_search_test
