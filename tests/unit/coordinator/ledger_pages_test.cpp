// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger_pages.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/random/rng.hpp"

using namespace sidestep;

namespace {

Ledger ledger_of(std::size_t robots, double half_side_m, Rng& rng) {
  FloorRules rules;
  rules.field = {100, 100};
  std::vector<RobotId> roster;
  for (RobotId robot = 0; robot < robots; ++robot) roster.push_back(robot);
  Ledger ledger(rules, roster);
  for (const RobotId robot : roster) {
    // A few are not on the floor.
    if (rng.chance(0.05)) continue;
    const Vec2 place(rng.uniform(-half_side_m, half_side_m), rng.uniform(-half_side_m, half_side_m));
    std::vector<Version> versions;
    for (std::uint64_t i = 0; i <= rng.below(3); ++i)
      versions.push_back({robot, 1, i + 1, 0, Trajectory::resting({}, place + i * Vec2(0.01, 0)), 0});
    (void)ledger.enter(robot, versions);
  }
  return ledger;
}

}  // namespace

TEST_CASE("the ledger's pages hold every version of every robot once, each within its page's rectangle") {
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
        const bool is_within = version.x_m() >= pages[i].low_x_m() && version.x_m() <= pages[i].high_x_m() &&
                               version.y_m() >= pages[i].low_y_m() && version.y_m() <= pages[i].high_y_m();
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

TEST_CASE("robots of one page are near to each other where there are many") {
  Rng rng(4);
  // A robot for each 0.7 m²: a page would fit a square with sides of 4.7 m, and where it lies in two strips,
  // a rectangle twice as long.
  for (const msg::LedgerPage& page : ledger_pages(ledger_of(1000, 13.2, rng), 1)) {
    CHECK(page.high_x_m() - page.low_x_m() < 10);
    CHECK(page.high_y_m() - page.low_y_m() < 10);
  }
}
