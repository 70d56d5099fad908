// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "agents/agent/neighbours.hpp"
#include "agents/safety/safety_search.hpp"
#include "common/messaging/codec.hpp"
#include "agents/safety/clearance_batch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {

const Time kStart = time_from_ns(5'000'000'000);
constexpr Duration kCycle{16'666'667};

Version random_version(RobotId robot, Rng& rng) {
  Trajectory trajectory(kStart - Duration{8'000'000}, {random_vector(rng, 1), random_vector(rng, 1.4)});
  append_stop(trajectory, 5);
  return {robot, 1, robot + 100u, 0, trajectory, 0};
}

/// How many allocations the work makes when it has been done a few hundred times before.
template <typename Work>
std::size_t allocations_once_warm(Work work) {
  for (int i = 0; i < 300; ++i) work();
  const std::size_t before = allocations();
  for (int i = 0; i < 300; ++i) work();
  return allocations() - before;
}

}  // namespace

TEST_CASE("an allocation is counted") {
  const std::size_t before = allocations();
  std::vector<int> numbers(100);
  CHECK(numbers.size() == 100);
  CHECK(allocations() > before);
}

TEST_CASE("a search allocates nothing once warm, whoever is near") {
  Rng rng(1);
  FloorRules rules;
  rules.obstacles = {{{0.5, 0.5}, 0.1}};
  SafetySearch search(rules, {});
  TrajectoryIndex crowd;
  std::vector<std::vector<Version>> scenes(60);
  for (auto& scene : scenes) {
    for (RobotId robot = 1; robot <= 20; ++robot) scene.push_back(random_version(robot, rng));
  }
  std::size_t i = 0, found = 0;
  CHECK(allocations_once_warm([&] {
          crowd.assign(scenes[i++ % scenes.size()]);
          const SearchQuery query{kStart, {{0, 0}, {1, 0}}, random_vector(rng, 3), kCycle};
          found += search.search(query, crowd, rng).count;
        }) == 0);
  CHECK(found > 0);
}

TEST_CASE("a batch allocates nothing once warm") {
  Rng rng(2);
  ClearanceBatch batch;
  std::vector<Version> others;
  std::vector<TrajectoryBounds> outlines;
  for (RobotId robot = 0; robot < 50; ++robot) {
    others.push_back(random_version(robot, rng));
    outlines.push_back(trajectory_bounds(others.back().trajectory));
  }
  std::size_t clear = 0;
  CHECK(allocations_once_warm([&] {
          batch.restart(kStart);
          for (std::size_t k = 0; k < others.size(); ++k) batch.add(outlines[k], others[k].trajectory, 0.19);
          for (const auto is_clear : batch.compare(random_version(99, rng).trajectory)) clear += is_clear;
        }) == 0);
  CHECK(clear > 0);
}

TEST_CASE("what the neighbours may be executing is kept without allocations once warm") {
  Rng rng(3);
  Neighbours neighbours(0);
  TrajectoryIndex crowd;
  neighbours.look_about({0, 0}, 2.5);
  std::vector<msg::LedgerPage> pages(40);
  for (std::size_t k = 0; k < pages.size(); ++k) {
    pages[k].page_index(static_cast<std::uint32_t>(k % 2));
    pages[k].page_count(2);
    pages[k].epoch(1);
    for (RobotId robot = 1; robot <= 30; ++robot) {
      pages[k].versions().push_back(encode(random_version(robot + 30 * static_cast<RobotId>(k % 2), rng)));
      // Others are not near any more, so that there are more and fewer.
      if (rng.chance(0.3)) pages[k].versions().back().x_m(50);
    }
    pages[k].low_x_m(-1);
    pages[k].low_y_m(-1);
    pages[k].high_x_m(50);
    pages[k].high_y_m(1);
  }
  std::uint64_t number = 0;
  std::size_t seen = 0;
  CHECK(allocations_once_warm([&] {
          msg::LedgerPage& page = pages[number % pages.size()];
          page.head().message_number(++number);
          neighbours.on_page(page);
          neighbours.gather({0, 0}, 1.6, crowd);
          seen += crowd.size();
          seen += neighbours.standing(kStart + std::chrono::seconds(5), {0, 0}, 8).size();
        }) == 0);
  CHECK(seen > 0);
}
