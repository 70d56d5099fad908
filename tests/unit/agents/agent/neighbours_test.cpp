// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/neighbours.hpp"

#include <algorithm>
#include <map>

#include "common/messaging/version_codec.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::neighbours_test {

const Time kNow = time_from_ns(5'000'000'000);

Version resting_version(RobotId robot, VersionNumber number, const Vec2& position) {
  return {robot, 1, number, 0, Trajectory::resting(kNow, position), 0};
}

msg::LedgerPage page_of(std::uint32_t index, std::uint64_t number, std::span<const Version> versions) {
  msg::LedgerPage page;
  page.page_index(index);
  page.header().sender(10000);
  page.epoch(1);
  page.header().message_number(number);
  for (const Version& version : versions) {
    const Vec2& position = version.trajectory.at_start().position_m;
    const bool is_first = page.versions().empty();
    page.min_x_m(is_first ? position.x() : std::min(page.min_x_m(), position.x()));
    page.min_y_m(is_first ? position.y() : std::min(page.min_y_m(), position.y()));
    page.max_x_m(is_first ? position.x() : std::max(page.max_x_m(), position.x()));
    page.max_y_m(is_first ? position.y() : std::max(page.max_y_m(), position.y()));
    page.versions().push_back(encode(version));
  }
  return page;
}

void receive(Neighbours& neighbours, const msg::LedgerPage& message) {
  const auto page = ReceivedPage::decode(message, kNow);
  REQUIRE(page);
  neighbours.on_page(*page);
}

std::vector<VersionNumber> versions_within(Neighbours& neighbours, const Vec2& centre, double horizon) {
  std::vector<VersionNumber> numbers;
  TrajectoryIndex index;
  neighbours.collect(centre, horizon, index);
  for (std::size_t i = 0; i < index.size(); ++i) numbers.push_back(index.version(i).number);
  std::ranges::sort(numbers);
  return numbers;
}

TEST_CASE("an agent knows exactly the versions within the horizon that the latest pages list") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  constexpr double kHorizon_m = 2.5;
  Neighbours neighbours(0);
  // Reference: the versions in each page's latest message that were within the horizon on arrival.
  std::map<std::uint32_t, std::vector<VersionNumber>> expected;
  std::uint64_t number = 0;
  Vec2 centre(0, 0);
  for (int step = 0; step < 5000; ++step) {
    centre += random_vector(rng, 0.2);
    neighbours.set_horizon(centre, kHorizon_m);
    const auto index = static_cast<std::uint32_t>(rng.below(100));
    const Vec2 about = centre + random_vector(rng, 6);
    std::vector<Version> versions;
    const auto count = rng.below(6);
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto robot = static_cast<RobotId>(rng.below(20));
      versions.push_back(resting_version(robot, ++number, about + random_vector(rng, 2)));
    }
    receive(neighbours, page_of(index, ++number, versions));
    expected[index].clear();
    for (const Version& version : versions) {
      if (version.robot != 0 &&
          (version.trajectory.at_start().position_m - centre).squaredNorm() <= kHorizon_m * kHorizon_m)
        expected[index].push_back(version.number);
    }
    std::vector<VersionNumber> all;
    for (const auto& [page, numbers] : expected) all.insert(all.end(), numbers.begin(), numbers.end());
    std::ranges::sort(all);
    REQUIRE(versions_within(neighbours, centre, 1e4) == all);
  }
  CHECK(neighbours.invalid() == 0);
}

TEST_CASE("older pages and pages of older epochs change nothing") {
  Neighbours neighbours(0);
  neighbours.set_horizon({0, 0}, 2);
  const Version a = resting_version(1, 10, {1, 0}), b = resting_version(1, 11, {1, 1});
  receive(neighbours, page_of(0, 5, {&a, 1}));
  receive(neighbours, page_of(0, 4, {&b, 1}));
  CHECK(versions_within(neighbours, {0, 0}, 2) == std::vector<VersionNumber>{10});
  auto old = page_of(0, 6, {&b, 1});
  old.epoch(0);
  receive(neighbours, old);
  CHECK(versions_within(neighbours, {0, 0}, 2) == std::vector<VersionNumber>{10});
  receive(neighbours, page_of(0, 6, {&b, 1}));
  CHECK(versions_within(neighbours, {0, 0}, 2) == std::vector<VersionNumber>{11});
}

TEST_CASE("a page with an invalid bounding rectangle is still used") {
  Neighbours neighbours(0);
  neighbours.set_horizon({0, 0}, 2);
  const Version a = resting_version(1, 10, {1, 0});
  auto page = page_of(0, 1, {&a, 1});
  page.min_x_m(std::nan(""));
  page.max_y_m(std::nan(""));
  receive(neighbours, page);
  CHECK(versions_within(neighbours, {0, 0}, 2) == std::vector<VersionNumber>{10});
}

TEST_CASE("malformed versions within the horizon are counted, and the other versions of the page are used") {
  Neighbours neighbours(0);
  neighbours.set_horizon({0, 0}, 2);
  const std::vector<Version> versions{resting_version(1, 10, {1, 0}), resting_version(2, 11, {0, 1}),
                                      resting_version(3, 12, {-1, 0}), resting_version(0, 13, {0, -1})};
  auto page = page_of(0, 1, versions);
  page.versions()[0].phase_count(99);
  page.versions()[1].vx_mps(std::nan(""));
  page.versions()[3].phase_count(99);  // the agent's own robot is skipped
  receive(neighbours, page);
  CHECK(versions_within(neighbours, {0, 0}, 2) == std::vector<VersionNumber>{12});
  CHECK(neighbours.invalid() == 2);
}

TEST_CASE("the nearest robots whose versions have all ended count as stationary") {
  Neighbours neighbours(0);
  neighbours.set_horizon({0, 0}, 5);
  std::vector<Version> versions;
  for (RobotId robot = 1; robot <= 5; ++robot)
    versions.push_back(resting_version(robot, robot, {0.5 * (6.0 - robot), 0}));
  // Robot 5 has another version, which moves later.
  Version leaving = resting_version(5, 50, {0.5, 0});
  leaving.trajectory.append(std::chrono::seconds(9), {0, 0});
  versions.push_back(leaving);
  receive(neighbours, page_of(0, 1, versions));
  const auto places = neighbours.find_stationary(kNow + std::chrono::seconds(1), {0, 0}, 2);
  REQUIRE(places.size() == 2);
  CHECK(places[0].position_m == Vec2(1.5, 0));
  CHECK(places[0].robot == 3);
  CHECK(places[0].intent == nullptr);
  CHECK(places[1].position_m == Vec2(1, 0));
}

TEST_CASE("a robot that was found at rest is known beyond the horizon until it moves") {
  Neighbours neighbours(0);
  const auto places = [&] {
    return neighbours.find_stationary(kNow + std::chrono::seconds(1), {0, 0}, 8).size();
  };
  const Version far = resting_version(2, 20, {3.5, 0});
  std::uint64_t number = 0;
  const auto receive_at = [&](double centre_x_m, const Version& version) {
    neighbours.set_horizon({centre_x_m, 0}, 2);
    receive(neighbours, page_of(0, ++number, std::vector<Version>{version, far}));
  };
  const Version resting = resting_version(1, 10, {1, 0});
  receive_at(0, resting);
  CHECK(places() == 1);
  receive_at(-2, resting);
  CHECK(places() == 1);
  Version leaving = resting_version(1, 11, {1, 0});
  leaving.trajectory.append(std::chrono::seconds(9), {0, 0});
  receive_at(-2, leaving);
  CHECK(places() == 0);
  // It is forgotten now, and so is not noticed when it rests again.
  receive_at(-2, resting_version(1, 12, {1, 0}));
  CHECK(places() == 0);
}

}  // namespace sidestep::neighbours_test
