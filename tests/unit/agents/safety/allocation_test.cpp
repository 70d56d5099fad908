// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"
#include "agents/agent/observed_obstacles.hpp"
#include "agents/agent/obstacle_list_decoder.hpp"
#include "agents/agent/world_state_decoder.hpp"
#include "agents/batch/batch_clearance.hpp"
#include "agents/batch/dispatch.hpp"
#include "agents/safety/safety_search.hpp"
#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/version_codec.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::allocation_test {

const Time kStart = time_from_ns(5'000'000'000);
constexpr Duration kCycle{16'666'667};

Version random_version(RobotId robot, Rng& rng) {
  Trajectory trajectory(kStart - Duration{8'000'000}, {random_vector(rng, 1), random_vector(rng, 1.4)});
  append_stop(trajectory, 5);
  return {robot, 1, robot + 100u, 0, trajectory, 0};
}

/// Number of allocations in a few hundred runs of the work, after as many warm-up runs.
template <typename Work>
std::size_t allocations_after_warm_up(Work work) {
  for (int i = 0; i < 300; ++i) work();
  const std::size_t before = allocation_count();
  for (int i = 0; i < 300; ++i) work();
  return allocation_count() - before;
}

TEST_CASE("the allocation counter counts an allocation") {
  const std::size_t before = allocation_count();
  std::vector<int> numbers(100);
  CHECK(numbers.size() == 100);
  CHECK(allocation_count() > before);
}

TEST_CASE("the safety search does not allocate memory after a warm-up, even if neighbours change") {
  Rng rng(1);
  FloorRules rules;
  rules.obstacles = {Circle{{0.5, 0.5}, 0.1}};
  SafetySearch search(rules);
  TrajectoryIndex index;
  std::vector<std::vector<Version>> scenes(60);
  for (auto& scene : scenes) {
    for (RobotId robot = 1; robot <= 20; ++robot) scene.push_back(random_version(robot, rng));
  }
  std::size_t i = 0, found = 0;
  CHECK(allocations_after_warm_up([&] {
          index.assign(scenes[i++ % scenes.size()]);
          const SearchQuery query{kStart, {{0, 0}, {1, 0}}, random_vector(rng, 3), kCycle};
          found += search.search(query, index, rng).count;
        }) == 0);
  CHECK(found > 0);
}

TEST_CASE("batched comparisons do not allocate memory after a warm-up") {
  Rng rng(2);
  batch::BatchClearance clearance(batch::best_kernels());
  std::vector<TrajectoryBounds> others;
  for (RobotId robot = 0; robot < 50; ++robot)
    others.push_back(trajectory_bounds(random_version(robot, rng).trajectory));
  std::size_t clear = 0;
  CHECK(allocations_after_warm_up([&] {
          clearance.reset(kStart);
          for (const TrajectoryBounds& other : others) clearance.add(other, 0.19);
          const Trajectory one = random_version(99, rng).trajectory;
          const TrajectoryBounds bounds = trajectory_bounds(one);
          clearance.sample(one.start(), bounds.first_s + bounds.second_s);
          clearance.compare(batch::track_of(bounds, one.start(), clearance.step_s()),
                            bounds.acceleration_mps2, 0);
          for (std::size_t lane = 0; lane < clearance.size(); ++lane) clear += clearance.is_clear(lane);
        }) == 0);
  CHECK(clear > 0);
}

TEST_CASE("storing neighbours does not allocate memory after a warm-up") {
  Rng rng(3);
  Neighbours neighbours(0);
  TrajectoryIndex index;
  neighbours.set_horizon({0, 0}, 2.5);
  std::vector<msg::LedgerPage> pages(40);
  for (std::size_t k = 0; k < pages.size(); ++k) {
    pages[k].page_index(static_cast<std::uint32_t>(k % 2));
    pages[k].page_count(2);
    pages[k].header().sender(10000);
    pages[k].epoch(1);
    for (RobotId robot = 1; robot <= 30; ++robot) {
      pages[k].versions().push_back(encode(random_version(robot + 30 * static_cast<RobotId>(k % 2), rng)));
      // Some robots are far away, so that the number of stored versions varies.
      if (rng.chance(0.3)) pages[k].versions().back().x_m(50);
    }
    pages[k].min_x_m(-1);
    pages[k].min_y_m(-1);
    pages[k].max_x_m(50);
    pages[k].max_y_m(1);
  }
  std::uint64_t number = 0;
  std::size_t collected = 0;
  CHECK(allocations_after_warm_up([&] {
          msg::LedgerPage& page = pages[number % pages.size()];
          page.header().message_number(++number);
          neighbours.on_page(*ReceivedPage::decode(page, kStart));
          neighbours.collect({0, 0}, 1.6, index);
          collected += index.size();
          collected += neighbours.find_stationary(kStart + std::chrono::seconds(5), {0, 0}, 8).size();
        }) == 0);
  CHECK(collected > 0);
}

TEST_CASE("decoding and encoding an agent's messages does not allocate memory") {
  Rng rng(4);
  RobotReport robot_report;
  robot_report.executing = random_version(0, rng);
  const msg::Feedback report_message = encode(robot_report);
  msg::Verdict verdict;
  verdict.header().sender(10000);
  msg::CoordinatorState state;
  state.header().sender(10000);
  state.notices().resize(3);
  msg::WorldState world;
  world.header().sender(20000);
  for (RobotId robot = 0; robot < 100; ++robot) world.robots().emplace_back().robot(robot);
  const Command command{0, 1, 0, Time{}, robot_report.executing};
  const Proposal proposal{0, 1, 0, Time{}, 0, 1, {robot_report.executing}};
  const Registration registration{0, 1, 0, Time{}, VersionSet()};
  WorldStateDecoder decoder(99);
  std::size_t decoded = 0;
  CHECK(allocations_after_warm_up([&] {
          decoded += decode(report_message, 0, kStart).has_value() + decode(verdict, 0).has_value();
          decoded += decode(state, kStart).has_value() + decoder.decode(world).self.has_value();
          decoded += encode(command).has_version() + encode(proposal).candidate_count() +
                     encode(registration).is_absent();
        }) == 0);
  CHECK(decoded == 7 * 600);
}

TEST_CASE("decoding, storing and avoiding listed obstacles does not allocate memory") {
  Rng rng(5);
  std::vector<msg::ObstacleList> lists(40);
  for (std::size_t k = 0; k < lists.size(); ++k) {
    lists[k].header().sender(20000);
    lists[k].complete_within_m(1);
    for (std::uint32_t i = 0; i < msg::MAX_OBSTACLES; ++i) {
      msg::TrackedObstacle& obstacle = lists[k].obstacles().emplace_back();
      obstacle.obstacle(static_cast<std::uint32_t>(rng.below(2000)));  // more tracks than can be stored
      obstacle.x_m(rng.uniform(-3, 3));
      obstacle.y_m(rng.uniform(-3, 3));
    }
  }
  ObstacleListDecoder decoder;
  ObservedObstacles obstacles(1.5, Duration{1'000'000});
  SafetySearch search({});
  TrajectoryIndex empty_index;
  Time now = kStart;
  std::size_t k = 0, stored = 0, found = 0;
  CHECK(allocations_after_warm_up([&] {
          msg::ObstacleList& list = lists[k++ % lists.size()];
          now += kCycle;
          list.valid_at_ns(to_ns(now));
          for (msg::TrackedObstacle& obstacle : list.obstacles()) obstacle.observed_at_ns(to_ns(now));
          obstacles.on_list(*decoder.decode(list), {0, 0}, now);
          SearchQuery query{now, {{0, 0}, {1, 0}}, random_vector(rng, 3), kCycle};
          query.moving = obstacles.recent(now, Duration{0});
          query.seen = obstacles.seen(now, Duration{0});
          stored += query.moving.size();
          found += search.search(query, empty_index, rng).count;
        }) == 0);
  CHECK(stored + found > 100 * ObservedObstacles::kCapacity);
}

}  // namespace sidestep::allocation_test
