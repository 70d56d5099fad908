// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "common/marking/pose_error.hpp"
#include "tests/unit/vision/patterns/scene.hpp"

using namespace sidestep;
using namespace sidestep::test;

namespace {

const MarkedRobot* found_at(std::span<const MarkedRobot> found, const Vec2& at_m) {
  const auto robot = std::ranges::find_if(
      found, [&](const MarkedRobot& one) { return (one.pose.position_m - at_m).norm() < 0.02; });
  return robot == found.end() ? nullptr : &*robot;
}

}  // namespace

TEST_CASE("every pattern of both teams is found where it is, with its heading and its colours") {
  const std::uint64_t seed = GENERATE(range(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<Marked> robots = scattered(butterfly(), 16, 0.18, rng);
  const auto patches = patches_of(butterfly(), robots, {0.0015, 0.1, 0}, rng);
  PatternFinder finder(butterfly());
  const auto found = finder.find(patches);
  REQUIRE(found.size() == robots.size());
  for (const Marked& robot : robots) {
    CAPTURE(robot.entry.robot);
    const MarkedRobot* seen = found_at(found, robot.pose.position_m);
    REQUIRE(seen);
    CHECK(seen->seen == 5);
    CHECK(std::abs(wrapped_rad(seen->pose.heading_rad - robot.pose.heading_rad)) < 0.06);
    for (const Marked& other : robots) {
      CHECK(seen->can_be(other.entry.team, other.entry.pattern) == (other.entry.robot == robot.entry.robot));
    }
  }
}

TEST_CASE("a robot with one dot hidden is found, and never taken for one that it cannot be") {
  const std::uint64_t seed = GENERATE(range(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<Marked> robots = scattered(butterfly(), 16, 0.18, rng);
  const auto patches = patches_of(butterfly(), robots, {0.0015, 0.1, 1}, rng);
  PatternFinder finder(butterfly());
  const auto found = finder.find(patches);
  CHECK(found.size() == robots.size());
  for (const Marked& robot : robots) {
    CAPTURE(robot.entry.robot);
    const MarkedRobot* seen = found_at(found, robot.pose.position_m);
    REQUIRE(seen);
    CHECK(seen->seen == 4);
    CHECK(std::abs(wrapped_rad(seen->pose.heading_rad - robot.pose.heading_rad)) < 0.08);
    CHECK(seen->can_be(robot.entry.team, robot.entry.pattern));
  }
}

TEST_CASE("dots that belong to nobody do no harm") {
  const std::uint64_t seed = GENERATE(range(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<Marked> robots = scattered(butterfly(), 11, 0.2, rng);
  auto patches = patches_of(butterfly(), robots, {0.001, 0.1, 0}, rng);
  const std::size_t own = patches.size();
  // One beside each robot, somewhere within its reach, but not on a dot.
  for (const Marked& robot : robots) {
    Vec2 at_m;
    bool is_free = false;
    while (!is_free) {
      at_m =
          robot.pose.position_m + rotated(Vec2(rng.uniform(0.03, 0.11), 0), rng.uniform(-3.14159, 3.14159));
      is_free = std::ranges::all_of(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(own),
                                    [&](const Patch& p) { return (p.position_m - at_m).norm() > 0.03; });
    }
    patches.push_back({rng.chance(0.5) ? Colour::kPink : Colour::kGreen, at_m, disc_m2(0.02)});
  }
  PatternFinder finder(butterfly());
  const auto found = finder.find(patches);
  CHECK(found.size() == robots.size());
  for (const Marked& robot : robots) {
    const MarkedRobot* seen = found_at(found, robot.pose.position_m);
    REQUIRE(seen);
    CHECK(seen->seen == 5);
    CHECK(seen->can_be(robot.entry.team, robot.entry.pattern));
  }
}

TEST_CASE("dots alone are no robot") {
  Rng rng(3);
  std::vector<Patch> patches;
  for (int i = 0; i < 200; ++i) {
    const auto colour = static_cast<Colour>(rng.below(kColours.size()));
    patches.push_back({colour, {rng.uniform(-30, 30), rng.uniform(-30, 30)}, disc_m2(0.02)});
  }
  PatternFinder finder(butterfly());
  CHECK(finder.find(patches).empty());
}

TEST_CASE("patches that are too small or too large on the floor are no dots") {
  Rng rng(4);
  const std::vector<Marked> robots = scattered(butterfly(), 1, 0.3, rng);
  const double factor = GENERATE(0.2, 4.0);
  auto patches = patches_of(butterfly(), robots, {}, rng);
  for (Patch& patch : patches) patch.area_m2 *= factor;
  PatternFinder finder(butterfly());
  CHECK(finder.find(patches).empty());
}

TEST_CASE("poses have the errors that the layout predicts") {
  constexpr double kDot_sd_m = 0.001;
  constexpr int kRounds = 4000;
  Rng rng(5);
  const PoseError predicted = predicted_pose_error(butterfly(), kDot_sd_m);
  PatternFinder finder(butterfly());
  double ahead2 = 0, aside2 = 0, heading2 = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Marked> robots = scattered(butterfly(), 1, 0.3, rng);
    const auto found = finder.find(patches_of(butterfly(), robots, {kDot_sd_m, 0, 0}, rng));
    const MarkedRobot* seen = found_at(found, robots[0].pose.position_m);
    REQUIRE(seen);
    const Vec2 error =
        rotated(seen->pose.position_m - robots[0].pose.position_m, -robots[0].pose.heading_rad);
    ahead2 += error.x() * error.x();
    aside2 += error.y() * error.y();
    heading2 += std::pow(wrapped_rad(seen->pose.heading_rad - robots[0].pose.heading_rad), 2);
  }
  // The standard deviation of such an estimate is 1.1 %.
  CHECK(std::sqrt(ahead2 / kRounds) == Approx(predicted.ahead_m).epsilon(0.05));
  CHECK(std::sqrt(aside2 / kRounds) == Approx(predicted.aside_m).epsilon(0.05));
  CHECK(std::sqrt(heading2 / kRounds) == Approx(predicted.heading_rad).epsilon(0.05));
}
