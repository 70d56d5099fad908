// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "tests/unit/vision/patterns/scene.hpp"

using namespace sidestep;
using namespace sidestep::test;

namespace {

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrame{16'666'667};

struct Tally {
  std::size_t right = 0, wrong = 0;
};

Tally tally(std::span<const IdentifiedRobot> found, const std::vector<Marked>& robots) {
  Tally t;
  for (const IdentifiedRobot& one : found) {
    const auto truth =
        std::ranges::find_if(robots, [&](const Marked& r) { return r.entry.robot == one.robot; });
    const bool is_right =
        truth != robots.end() && (truth->pose.position_m - one.seen.pose.position_m).norm() < 0.02;
    ++(is_right ? t.right : t.wrong);
  }
  return t;
}

/// Somewhere within 3 cm of their places.
std::vector<Marked> moved(std::vector<Marked> robots, Rng& rng) {
  for (Marked& robot : robots) {
    robot.pose.position_m += rotated(Vec2(rng.uniform(0, 0.03), 0), rng.uniform(-3.14159, 3.14159));
    robot.pose.heading_rad += rng.uniform(-0.2, 0.2);
  }
  return robots;
}

}  // namespace

TEST_CASE("robots all of whose dots are seen are known at once") {
  Rng rng(1);
  const std::vector<Marked> robots = scattered(butterfly(), 16, 0.2, rng);
  PatternFinder finder(butterfly());
  Identifier identifier(roster_of(robots));
  const auto found =
      identifier.identify(kBegin, finder.find(patches_of(butterfly(), robots, {0.001, 0.1, 0}, rng)), {});
  CHECK(tally(found, robots).right == robots.size());
  CHECK(tally(found, robots).wrong == 0);
}

TEST_CASE("with one dot hidden robots are known where they are expected") {
  const std::uint64_t seed = GENERATE(range(1, 11));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<Marked> places = scattered(butterfly(), 16, 0.25, rng);
  std::vector<Marked> robots = places;
  PatternFinder finder(butterfly());
  Identifier identifier(roster_of(robots));
  for (int frame = 0; frame < 50; ++frame) {
    const auto expected = expected_of(robots);
    robots = moved(places, rng);
    const auto patches = patches_of(butterfly(), robots, {0.001, 0.1, 1}, rng);
    const Tally t =
        tally(identifier.identify(kBegin + frame * kFrame, finder.find(patches), expected), robots);
    CHECK(t.right == robots.size());
    CHECK(t.wrong == 0);
  }
}

TEST_CASE("robots that nobody has ever seen as a whole become known by what is left over") {
  const std::uint64_t seed = GENERATE(range(1, 11));
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Marked> robots = scattered(butterfly(), 11, 0.3, rng);
  PatternFinder finder(butterfly());
  Identifier identifier(roster_of(robots));
  std::vector<bool> is_known(32);
  for (int frame = 0; frame < 40; ++frame) {
    for (Marked& robot : robots) robot.pose.position_m += 0.005 * Vec2(rng.normal(), rng.normal());
    const auto found = identifier.identify(
        kBegin + frame * kFrame, finder.find(patches_of(butterfly(), robots, {0.001, 0.1, 1}, rng)), {});
    CHECK(tally(found, robots).wrong == 0);
    for (const IdentifiedRobot& one : found) is_known[one.robot] = true;
  }
  CHECK(std::ranges::count(is_known, true) == static_cast<std::ptrdiff_t>(robots.size()));
}

TEST_CASE("who is expected somewhere is not mistaken for somebody whose dots are misread") {
  Rng rng(2);
  std::vector<Marked> robots = scattered(butterfly(), 16, 0.3, rng);
  const std::vector<RosterEntry> roster = roster_of(robots);
  const auto expected = expected_of(robots);
  robots.resize(1);
  std::vector<Marked> misread = robots;
  misread[0].entry.pattern = butterfly().patterns[1];
  PatternFinder finder(butterfly());
  Identifier identifier(roster);
  CHECK(
      identifier.identify(kBegin, finder.find(patches_of(butterfly(), misread, {}, rng)), expected).empty());
  CHECK(identifier.identify(kBegin, finder.find(patches_of(butterfly(), robots, {}, rng)), expected).size() ==
        1);
  // Where nobody is expected dots are believed.
  CHECK(
      identifier.identify(kBegin, finder.find(patches_of(butterfly(), misread, {}, rng)), {}).front().robot ==
      1);
}

TEST_CASE("robots that pass each other closely keep their names although a dot of each is hidden") {
  const std::uint64_t seed = GENERATE(range(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const auto& patterns = butterfly().patterns;
  // 0 and 10 differ in one dot.
  std::vector<Marked> robots{{{0, Team::kBlue, patterns[0]}, {{-0.5, 0.095}, 0.3}},
                             {{10, Team::kBlue, patterns[10]}, {{0.5, -0.095}, -0.4}}};
  PatternFinder finder(butterfly());
  Identifier identifier(roster_of(robots));
  std::size_t right = 0, wrong = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const auto expected = expected_of(robots);
    robots[0].pose.position_m.x() += 0.017;
    robots[1].pose.position_m.x() -= 0.017;
    const auto patches = patches_of(butterfly(), robots, {0.0015, 0.1, 1}, rng);
    const Tally t =
        tally(identifier.identify(kBegin + frame * kFrame, finder.find(patches), expected), robots);
    right += t.right;
    wrong += t.wrong;
  }
  CHECK(right >= 118);
  CHECK(wrong == 0);
}

TEST_CASE("robots that are not in the roster are nobody") {
  Rng rng(3);
  const std::vector<Marked> robots = scattered(butterfly(), 4, 0.3, rng);
  PatternFinder finder(butterfly());
  std::vector<RosterEntry> roster = roster_of(robots);
  roster.erase(roster.begin());
  Identifier identifier(roster);
  const auto found = identifier.identify(kBegin, finder.find(patches_of(butterfly(), robots, {}, rng)), {});
  CHECK(found.size() == roster.size());
  CHECK(tally(found, robots).wrong == 0);
}
