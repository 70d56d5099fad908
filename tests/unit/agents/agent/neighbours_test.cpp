// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "common/messaging/codec.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {

const Time kNow = time_from_ns(5'000'000'000);

Version standing(RobotId robot, VersionNumber number, const Vec2& place) {
  return {robot, 1, number, 0, Trajectory::resting(kNow, place), 0};
}

msg::LedgerPage page_of(std::uint32_t index, std::uint64_t number, std::span<const Version> versions) {
  msg::LedgerPage page;
  page.page_index(index);
  page.epoch(1);
  page.head().message_number(number);
  for (const Version& version : versions) {
    const Vec2& place = version.trajectory.at_start().position_m;
    const bool first = page.versions().empty();
    page.low_x_m(first ? place.x() : std::min(page.low_x_m(), place.x()));
    page.low_y_m(first ? place.y() : std::min(page.low_y_m(), place.y()));
    page.high_x_m(first ? place.x() : std::max(page.high_x_m(), place.x()));
    page.high_y_m(first ? place.y() : std::max(page.high_y_m(), place.y()));
    page.versions().push_back(encode(version));
  }
  return page;
}

std::vector<VersionNumber> held(Neighbours& neighbours, const Vec2& here, double horizon) {
  std::vector<VersionNumber> numbers;
  TrajectoryIndex crowd;
  neighbours.gather(here, horizon, crowd);
  for (std::size_t i = 0; i < crowd.size(); ++i) numbers.push_back(crowd.version(i).number);
  std::ranges::sort(numbers);
  return numbers;
}

}  // namespace

TEST_CASE("of the latest pages all versions within the horizon are known, and no others") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  constexpr double kHorizon_m = 2.5;
  Neighbours neighbours(0);
  // As slow as can be: the versions of each page's latest message, as many as were within the horizon then.
  std::map<std::uint32_t, std::vector<VersionNumber>> expected;
  std::uint64_t number = 0;
  Vec2 here(0, 0);
  for (int step = 0; step < 5000; ++step) {
    here += random_vector(rng, 0.2);
    neighbours.look_about(here, kHorizon_m);
    const auto index = static_cast<std::uint32_t>(rng.below(100));
    const Vec2 about = here + random_vector(rng, 6);
    std::vector<Version> versions;
    const auto count = rng.below(6);
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto robot = static_cast<RobotId>(rng.below(20));
      versions.push_back(standing(robot, ++number, about + random_vector(rng, 2)));
    }
    neighbours.on_page(page_of(index, ++number, versions));
    expected[index].clear();
    for (const Version& version : versions) {
      if (version.robot != 0 &&
          (version.trajectory.at_start().position_m - here).squaredNorm() <= kHorizon_m * kHorizon_m)
        expected[index].push_back(version.number);
    }
    std::vector<VersionNumber> all;
    for (const auto& [page, numbers] : expected) all.insert(all.end(), numbers.begin(), numbers.end());
    std::ranges::sort(all);
    REQUIRE(held(neighbours, here, 1e4) == all);
  }
  CHECK(neighbours.invalid() == 0);
}

TEST_CASE("an older page changes nothing, and neither does one of an older epoch") {
  Neighbours neighbours(0);
  neighbours.look_about({0, 0}, 2);
  const Version a = standing(1, 10, {1, 0}), b = standing(1, 11, {1, 1});
  neighbours.on_page(page_of(0, 5, {&a, 1}));
  neighbours.on_page(page_of(0, 4, {&b, 1}));
  CHECK(held(neighbours, {0, 0}, 2) == std::vector<VersionNumber>{10});
  auto old = page_of(0, 6, {&b, 1});
  old.epoch(0);
  neighbours.on_page(old);
  CHECK(held(neighbours, {0, 0}, 2) == std::vector<VersionNumber>{10});
  neighbours.on_page(page_of(0, 6, {&b, 1}));
  CHECK(held(neighbours, {0, 0}, 2) == std::vector<VersionNumber>{11});
}

TEST_CASE("a page whose rectangle makes no sense is looked at all the same") {
  Neighbours neighbours(0);
  neighbours.look_about({0, 0}, 2);
  const Version a = standing(1, 10, {1, 0});
  auto page = page_of(0, 1, {&a, 1});
  page.low_x_m(std::nan(""));
  page.high_y_m(std::nan(""));
  neighbours.on_page(page);
  CHECK(held(neighbours, {0, 0}, 2) == std::vector<VersionNumber>{10});
}

TEST_CASE("those stand who have been at rest with all they may execute, the nearest first of all") {
  Neighbours neighbours(0);
  neighbours.look_about({0, 0}, 5);
  std::vector<Version> versions;
  for (RobotId robot = 1; robot <= 5; ++robot)
    versions.push_back(standing(robot, robot, {0.5 * (6.0 - robot), 0}));
  // Robot 5 is about to move.
  Version leaving = standing(5, 50, {0.5, 0});
  leaving.trajectory.append(std::chrono::seconds(9), {0, 0});
  versions.push_back(leaving);
  neighbours.on_page(page_of(0, 1, versions));
  const auto places = neighbours.standing(kNow + std::chrono::seconds(1), {0, 0}, 2);
  REQUIRE(places.size() == 2);
  CHECK(places[0] == Vec2(1.5, 0));
  CHECK(places[1] == Vec2(1, 0));
}
