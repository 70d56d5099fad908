// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "tests/catch.hpp"
#include "tests/unit/common/random/normal_vector.hpp"
#include "tests/unit/vision/patterns/placed_robots.hpp"

namespace sidestep::identifier_test {

using namespace sidestep::test;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrame{16'666'667};

struct Tally {
  std::size_t correct = 0, wrong = 0;
};

Tally tally(std::span<const IdentifiedRobot> found, const std::vector<PlacedRobot>& robots) {
  Tally t;
  for (const IdentifiedRobot& one : found) {
    const auto truth =
        std::ranges::find_if(robots, [&](const PlacedRobot& r) { return r.entry.robot == one.robot; });
    const bool is_correct =
        truth != robots.end() && (truth->pose.position_m - one.pattern.pose.position_m).norm() < 0.02;
    ++(is_correct ? t.correct : t.wrong);
  }
  return t;
}

/// Displaces robots randomly by up to 3 cm.
std::vector<PlacedRobot> moved(std::vector<PlacedRobot> robots, Rng& rng) {
  for (PlacedRobot& robot : robots) {
    const double angle_rad = rng.uniform(-std::numbers::pi, std::numbers::pi);
    robot.pose.position_m += rotated(Vec2(rng.uniform(0, 0.03), 0), angle_rad);
    robot.pose.heading_rad += rng.uniform(-0.2, 0.2);
  }
  return robots;
}

TEST_CASE("robots with all dots visible are identified immediately") {
  Rng rng(1);
  const std::vector<PlacedRobot> robots = scattered(butterfly(), 16, 0.2, rng);
  PatternFinder finder(butterfly());
  Identifier identifier(roster_of(robots));
  const auto found =
      identifier.identify(kBegin, finder.find(regions_of(butterfly(), robots, {0.001, 0.1, 0}, rng)), {});
  CHECK(tally(found, robots).correct == robots.size());
  CHECK(tally(found, robots).wrong == 0);
}

TEST_CASE("robots with one hidden dot are identified where they are expected") {
  const std::uint64_t seed = GENERATE(range(1, 11));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<PlacedRobot> initial = scattered(butterfly(), 16, 0.25, rng);
  std::vector<PlacedRobot> robots = initial;
  PatternFinder finder(butterfly());
  Identifier identifier(roster_of(robots));
  for (int frame = 0; frame < 50; ++frame) {
    const auto expected = expected_of(robots);
    robots = moved(initial, rng);
    const auto regions = regions_of(butterfly(), robots, {0.001, 0.1, 1}, rng);
    const Tally t =
        tally(identifier.identify(kBegin + frame * kFrame, finder.find(regions), expected), robots);
    CHECK(t.correct == robots.size());
    CHECK(t.wrong == 0);
  }
}

TEST_CASE("robots never observed with all dots are identified from the history of matches") {
  const std::uint64_t seed = GENERATE(range(1, 11));
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<PlacedRobot> robots = scattered(butterfly(), 11, 0.3, rng);
  PatternFinder finder(butterfly());
  Identifier identifier(roster_of(robots));
  std::vector<bool> is_known(32);
  for (int frame = 0; frame < 40; ++frame) {
    for (PlacedRobot& robot : robots) robot.pose.position_m += 0.005 * normal_vector(rng);
    const auto found = identifier.identify(
        kBegin + frame * kFrame, finder.find(regions_of(butterfly(), robots, {0.001, 0.1, 1}, rng)), {});
    CHECK(tally(found, robots).wrong == 0);
    for (const IdentifiedRobot& one : found) is_known[one.robot] = true;
  }
  CHECK(std::ranges::count(is_known, true) == static_cast<std::ptrdiff_t>(robots.size()));
}

TEST_CASE("an expected robot is not mistaken for another when a dot is misread") {
  Rng rng(2);
  std::vector<PlacedRobot> robots = scattered(butterfly(), 16, 0.3, rng);
  const std::vector<RosterEntry> roster = roster_of(robots);
  const auto expected = expected_of(robots);
  robots.resize(1);
  std::vector<PlacedRobot> misread = robots;
  misread[0].entry.pattern = butterfly().patterns[1];
  PatternFinder finder(butterfly());
  Identifier identifier(roster);
  CHECK(
      identifier.identify(kBegin, finder.find(regions_of(butterfly(), misread, {}, rng)), expected).empty());
  CHECK(identifier.identify(kBegin, finder.find(regions_of(butterfly(), robots, {}, rng)), expected).size() ==
        1);
  // Where no robot is expected, the dots decide.
  CHECK(
      identifier.identify(kBegin, finder.find(regions_of(butterfly(), misread, {}, rng)), {}).front().robot ==
      1);
}

TEST_CASE("robots that pass each other closely keep their identities with one dot of each hidden") {
  const std::uint64_t seed = GENERATE(range(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const auto& patterns = butterfly().patterns;
  // Patterns 0 and 10 differ in one dot.
  std::vector<PlacedRobot> robots{{{0, Team::kBlue, patterns[0]}, {{-0.5, 0.095}, 0.3}},
                                  {{10, Team::kBlue, patterns[10]}, {{0.5, -0.095}, -0.4}}};
  PatternFinder finder(butterfly());
  Identifier identifier(roster_of(robots));
  std::size_t correct = 0, wrong = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const auto expected = expected_of(robots);
    robots[0].pose.position_m.x() += 0.017;
    robots[1].pose.position_m.x() -= 0.017;
    const auto regions = regions_of(butterfly(), robots, {0.0015, 0.1, 1}, rng);
    const Tally t =
        tally(identifier.identify(kBegin + frame * kFrame, finder.find(regions), expected), robots);
    correct += t.correct;
    wrong += t.wrong;
  }
  CHECK(correct >= 118);
  CHECK(wrong == 0);
}

TEST_CASE("robots that are not on the roster are not identified") {
  Rng rng(3);
  const std::vector<PlacedRobot> robots = scattered(butterfly(), 4, 0.3, rng);
  PatternFinder finder(butterfly());
  std::vector<RosterEntry> roster = roster_of(robots);
  roster.erase(roster.begin());
  Identifier identifier(roster);
  const auto found = identifier.identify(kBegin, finder.find(regions_of(butterfly(), robots, {}, rng)), {});
  CHECK(found.size() == roster.size());
  CHECK(tally(found, robots).wrong == 0);
}

}  // namespace sidestep::identifier_test
