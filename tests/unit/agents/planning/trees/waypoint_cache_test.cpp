// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/trees/waypoint_cache.hpp"

#include <set>

#include "tests/catch.hpp"

namespace sidestep::waypoint_cache_test {

std::set<int> contents(const WaypointCache<int>& cache) {
  std::set<int> states;
  for (std::size_t i = 0; i < cache.size(); ++i) states.insert(cache[i]);
  return states;
}

WaypointCache<int> filled(CacheReplacement replacement, Rng& rng) {
  WaypointCache<int> cache(4, replacement);
  cache.store({1, 2}, rng);
  cache.store({3, 4}, rng);
  return cache;
}

TEST_CASE("a cache that is not full stores every waypoint") {
  Rng rng(1);
  for (const auto replacement :
       {CacheReplacement::kRandom, CacheReplacement::kOldest, CacheReplacement::kLeastRecentlyUsed})
    CHECK(contents(filled(replacement, rng)) == std::set{1, 2, 3, 4});
}

TEST_CASE("with first-in-first-out replacement, a full cache drops its oldest waypoints, used or not") {
  Rng rng(1);
  auto cache = filled(CacheReplacement::kOldest, rng);
  cache.use(0);
  cache.store({5}, rng);
  CHECK(contents(cache) == std::set{2, 3, 4, 5});
  cache.store({6, 7}, rng);
  CHECK(contents(cache) == std::set{4, 5, 6, 7});
}

TEST_CASE("with least-recently-used replacement, a full cache keeps a used waypoint") {
  Rng rng(1);
  auto cache = filled(CacheReplacement::kLeastRecentlyUsed, rng);
  cache.use(0);  // a plan grew towards waypoint 1
  cache.store({5}, rng);
  CHECK(contents(cache) == std::set{1, 3, 4, 5});
  cache.store({6, 7}, rng);
  CHECK(contents(cache) == std::set{1, 5, 6, 7});
}

TEST_CASE("with least-recently-used replacement, a full cache drops its oldest waypoints if all were used") {
  Rng rng(1);
  auto cache = filled(CacheReplacement::kLeastRecentlyUsed, rng);
  for (std::size_t i = 0; i < 4; ++i) cache.use(i);
  cache.store({5, 6}, rng);
  CHECK(contents(cache) == std::set{3, 4, 5, 6});
}

TEST_CASE("a whole-plan cache holds only the last plan") {
  Rng rng(1);
  auto cache = filled(CacheReplacement::kWholePlan, rng);
  CHECK(contents(cache) == std::set{3, 4});
  cache.store({5, 6, 7}, rng);
  CHECK(contents(cache) == std::set{5, 6, 7});
}

TEST_CASE("random replacement drops all old waypoints equally often") {
  Rng rng(3);
  int kept[4] = {};
  for (int round = 0; round < 4000; ++round) {
    auto cache = filled(CacheReplacement::kRandom, rng);
    cache.store({5}, rng);
    const auto states = contents(cache);
    REQUIRE(states.count(5) == 1);
    for (int i = 0; i < 4; ++i) kept[i] += states.count(i + 1) > 0 ? 1 : 0;
  }
  for (const int count : kept) CHECK(count == Approx(3000).margin(150));
}

TEST_CASE("a cache with zero capacity stays empty") {
  Rng rng(1);
  WaypointCache<int> cache(0);
  cache.store({1, 2, 3}, rng);
  CHECK(cache.is_empty());
}

}  // namespace sidestep::waypoint_cache_test
