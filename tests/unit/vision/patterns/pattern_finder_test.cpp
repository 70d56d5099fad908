// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "common/marking/pose_error.hpp"
#include "tests/catch.hpp"
#include "tests/unit/vision/patterns/placed_robots.hpp"

namespace sidestep::pattern_finder_test {

using namespace sidestep::test;

const DetectedPattern* found_at(std::span<const DetectedPattern> found, const Vec2& position_m) {
  const auto robot = std::ranges::find_if(
      found, [&](const DetectedPattern& one) { return (one.pose.position_m - position_m).norm() < 0.02; });
  return robot == found.end() ? nullptr : &*robot;
}

TEST_CASE("every pattern of both teams is found with its position, heading and colours") {
  const std::uint64_t seed = GENERATE(range(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<PlacedRobot> robots = scattered(butterfly(), 16, 0.18, rng);
  const auto regions = regions_of(butterfly(), robots, {0.0015, 0.1, 0}, rng);
  PatternFinder finder(butterfly());
  const auto found = finder.find(regions);
  REQUIRE(found.size() == robots.size());
  for (const PlacedRobot& robot : robots) {
    CAPTURE(robot.entry.robot);
    const DetectedPattern* pattern = found_at(found, robot.pose.position_m);
    REQUIRE(pattern);
    CHECK(pattern->dot_count == 5);
    CHECK(std::abs(wrapped_rad(pattern->pose.heading_rad - robot.pose.heading_rad)) < 0.06);
    for (const PlacedRobot& other : robots) {
      CHECK(pattern->matches(other.entry.team, other.entry.pattern) ==
            (other.entry.robot == robot.entry.robot));
    }
  }
}

TEST_CASE("a robot with one hidden dot is found, and its pattern still matches") {
  const std::uint64_t seed = GENERATE(range(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<PlacedRobot> robots = scattered(butterfly(), 16, 0.18, rng);
  const auto regions = regions_of(butterfly(), robots, {0.0015, 0.1, 1}, rng);
  PatternFinder finder(butterfly());
  const auto found = finder.find(regions);
  CHECK(found.size() == robots.size());
  for (const PlacedRobot& robot : robots) {
    CAPTURE(robot.entry.robot);
    const DetectedPattern* pattern = found_at(found, robot.pose.position_m);
    REQUIRE(pattern);
    CHECK(pattern->dot_count == 4);
    CHECK(std::abs(wrapped_rad(pattern->pose.heading_rad - robot.pose.heading_rad)) < 0.08);
    CHECK(pattern->matches(robot.entry.team, robot.entry.pattern));
  }
}

TEST_CASE("dots that belong to no robot are ignored") {
  const std::uint64_t seed = GENERATE(range(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<PlacedRobot> robots = scattered(butterfly(), 11, 0.2, rng);
  auto regions = regions_of(butterfly(), robots, {0.001, 0.1, 0}, rng);
  const std::size_t own = regions.size();
  // One stray dot near each robot, away from the robot's own dots.
  for (const PlacedRobot& robot : robots) {
    Vec2 position_m;
    bool is_free = false;
    while (!is_free) {
      const double angle_rad = rng.uniform(-std::numbers::pi, std::numbers::pi);
      position_m = robot.pose.position_m + rotated(Vec2(rng.uniform(0.03, 0.11), 0), angle_rad);
      is_free = std::ranges::all_of(
          regions.begin(), regions.begin() + static_cast<std::ptrdiff_t>(own),
          [&](const ProjectedRegion& p) { return (p.position_m - position_m).norm() > 0.03; });
    }
    regions.push_back({rng.chance(0.5) ? Colour::kPink : Colour::kGreen, position_m, disc_m2(0.02)});
  }
  PatternFinder finder(butterfly());
  const auto found = finder.find(regions);
  CHECK(found.size() == robots.size());
  for (const PlacedRobot& robot : robots) {
    const DetectedPattern* pattern = found_at(found, robot.pose.position_m);
    REQUIRE(pattern);
    CHECK(pattern->dot_count == 5);
    CHECK(pattern->matches(robot.entry.team, robot.entry.pattern));
  }
}

TEST_CASE("scattered dots form no robot") {
  Rng rng(3);
  std::vector<ProjectedRegion> regions;
  for (int i = 0; i < 200; ++i) {
    const auto colour = static_cast<Colour>(rng.below(kColours.size()));
    regions.push_back({colour, {rng.uniform(-30, 30), rng.uniform(-30, 30)}, disc_m2(0.02)});
  }
  PatternFinder finder(butterfly());
  CHECK(finder.find(regions).empty());
}

TEST_CASE("regions that are too small or too large do not count as dots") {
  Rng rng(4);
  const std::vector<PlacedRobot> robots = scattered(butterfly(), 1, 0.3, rng);
  const double factor = GENERATE(0.2, 4.0);
  auto regions = regions_of(butterfly(), robots, {}, rng);
  for (ProjectedRegion& region : regions) region.area_m2 *= factor;
  PatternFinder finder(butterfly());
  CHECK(finder.find(regions).empty());
}

TEST_CASE("pose errors are as large as predicted for the layout") {
  constexpr double kDot_sd_m = 0.001;
  constexpr int kRounds = 4000;
  Rng rng(5);
  const PoseError predicted = predicted_pose_error(butterfly(), kDot_sd_m);
  PatternFinder finder(butterfly());
  double longitudinal2 = 0, lateral2 = 0, heading2 = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<PlacedRobot> robots = scattered(butterfly(), 1, 0.3, rng);
    const auto found = finder.find(regions_of(butterfly(), robots, {kDot_sd_m, 0, 0}, rng));
    const DetectedPattern* pattern = found_at(found, robots[0].pose.position_m);
    REQUIRE(pattern);
    const Vec2 error =
        rotated(pattern->pose.position_m - robots[0].pose.position_m, -robots[0].pose.heading_rad);
    longitudinal2 += error.x() * error.x();
    lateral2 += error.y() * error.y();
    heading2 += std::pow(wrapped_rad(pattern->pose.heading_rad - robots[0].pose.heading_rad), 2);
  }
  // These estimates have a relative standard deviation of 1.1 %.
  CHECK(std::sqrt(longitudinal2 / kRounds) == Approx(predicted.longitudinal_m).epsilon(0.05));
  CHECK(std::sqrt(lateral2 / kRounds) == Approx(predicted.lateral_m).epsilon(0.05));
  CHECK(std::sqrt(heading2 / kRounds) == Approx(predicted.heading_rad).epsilon(0.05));
}

}  // namespace sidestep::pattern_finder_test
