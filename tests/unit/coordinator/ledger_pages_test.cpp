// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger_pages.hpp"

#include <algorithm>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::ledger_pages_test {

Ledger ledger_of(std::size_t robots, double half_side_m, Rng& rng) {
  FloorRules rules;
  rules.field = {100, 100};
  std::vector<RobotId> roster;
  for (RobotId robot = 0; robot < robots; ++robot) roster.push_back(robot);
  Ledger ledger(rules, roster);
  for (const RobotId robot : roster) {
    // A few robots are absent.
    if (rng.chance(0.05)) continue;
    const double y = rng.uniform(-half_side_m, half_side_m), x = rng.uniform(-half_side_m, half_side_m);
    const Vec2 position(x, y);
    std::vector<Version> versions;
    for (std::uint64_t i = 0; i <= rng.below(3); ++i)
      versions.push_back({robot, 1, i + 1, 0, Trajectory::resting({}, position + i * Vec2(0.01, 0)), 0});
    (void)ledger.register_robot(robot, versions);
  }
  return ledger;
}

TEST_CASE("each version is on one ledger page, within that page's bounding box") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  for (const std::size_t robots : {1u, 31u, 32u, 33u, 70u, 200u, 1000u}) {
    CAPTURE(robots);
    const Ledger ledger = ledger_of(robots, 13, rng);
    const auto pages = ledger_pages(ledger, 7);
    REQUIRE(pages.size() == (robots + kRobotsPerPage - 1) / kRobotsPerPage);
    std::vector<std::pair<RobotId, VersionNumber>> seen, held;
    for (std::size_t i = 0; i < pages.size(); ++i) {
      CHECK(pages[i].page_index() == i);
      CHECK(pages[i].page_count() == pages.size());
      CHECK(pages[i].epoch() == 7);
      CHECK(pages[i].versions().size() <= 256);
      for (const msg::Version& version : pages[i].versions()) {
        seen.emplace_back(version.robot(), version.version_number());
        const bool is_within = version.x_m() >= pages[i].min_x_m() && version.x_m() <= pages[i].max_x_m() &&
                               version.y_m() >= pages[i].min_y_m() && version.y_m() <= pages[i].max_y_m();
        REQUIRE(is_within);
      }
    }
    for (const RobotId robot : ledger.roster()) {
      for (const Version& version : ledger.versions(robot)) held.emplace_back(robot, version.number);
    }
    std::ranges::sort(seen);
    REQUIRE(seen == held);
  }
}

TEST_CASE("on a crowded floor, the robots of a page are close together") {
  Rng rng(4);
  // At 0.7 m² per robot, a page covers a square of 4.7 m, or a rectangle twice as long if it spans two
  // strips.
  for (const msg::LedgerPage& page : ledger_pages(ledger_of(1000, 13.2, rng), 1)) {
    CHECK(page.max_x_m() - page.min_x_m() < 10);
    CHECK(page.max_y_m() - page.min_y_m() < 10);
  }
}

}  // namespace sidestep::ledger_pages_test
