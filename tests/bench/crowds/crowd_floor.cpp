// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_floor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sidestep {
namespace {

/// Clearance in addition to what the rules require, so that noise cannot close a gap.
constexpr double kSpare_m = 0.02;
constexpr int kPlaceAttempts = 2000, kSceneAttempts = 100;

}  // namespace

Vec2 random_point(const Box& box, Rng& rng) {
  const double x = rng.uniform(box.min_m.x(), box.max_m.x());
  const double y = rng.uniform(box.min_m.y(), box.max_m.y());
  return {x, y};
}

Box CrowdFloor::robot_area() const {
  const Vec2 half_m(field().length_m / 2, field().width_m / 2);
  return inflated({-half_m, half_m}, -(scenario_.radius_m + kSpare_m));
}

bool CrowdFloor::has_room(const Vec2& place_m, const std::vector<Vec2>& others_m) const {
  const double gap_m = 2 * (scenario_.radius_m + scenario_.margin_m) + kSpare_m;
  return std::ranges::all_of(scenario_.obstacles,
                             [&](const Shape& obstacle) {
                               return signed_distance(place_m, obstacle) >= scenario_.radius_m + gap_m;
                             }) &&
         std::ranges::all_of(others_m, [&](const Vec2& other_m) {
           return (place_m - other_m).norm() >= 2 * scenario_.radius_m + gap_m;
         });
}

std::optional<Vec2> CrowdFloor::random_place(const std::vector<Vec2>& others_m, const Vec2* start_m,
                                             const Box& area) {
  for (int attempt = 0; attempt < kPlaceAttempts; ++attempt) {
    const Vec2 place_m = random_point(area, rng_);
    if (start_m != nullptr && (place_m - *start_m).norm() < kMinTravel_m) continue;
    if (has_room(place_m, others_m)) return place_m;
  }
  return std::nullopt;
}

std::vector<Vec2> CrowdFloor::random_places(std::size_t count, const Box& area) {
  for (int attempt = 0; attempt < kSceneAttempts; ++attempt) {
    std::vector<Vec2> places_m;
    while (places_m.size() < count) {
      const auto place_m = random_place(places_m, nullptr, area);
      if (!place_m) break;
      places_m.push_back(*place_m);
    }
    if (places_m.size() == count) return places_m;
  }
  throw std::runtime_error("the area is too crowded for the robots of a crowd scene");
}

std::vector<Vec2> CrowdFloor::random_goals(const std::vector<Vec2>& starts_m, const Box& area) {
  for (int attempt = 0; attempt < kSceneAttempts; ++attempt) {
    std::vector<Vec2> goals_m;
    for (const Vec2& start_m : starts_m) {
      const auto goal_m = random_place(goals_m, &start_m, area);
      if (!goal_m) break;
      goals_m.push_back(*goal_m);
    }
    if (goals_m.size() == starts_m.size()) return goals_m;
  }
  throw std::runtime_error("the area is too crowded for the goals of a crowd scene");
}

void CrowdFloor::add_robot(const Vec2& start_m, const Goal& goal, Team team) {
  const Vec2 way_m = goal.position_m - start_m;
  RobotSpec robot;
  robot.team = team;
  robot.start_m = start_m;
  robot.start_heading_rad = std::atan2(way_m.y(), way_m.x());
  robot.goals.push_back(goal);
  scenario_.robots.push_back(std::move(robot));
}

void CrowdFloor::add_robots(const std::vector<Vec2>& starts_m, const std::vector<Vec2>& goals_m, Team team) {
  for (std::size_t i = 0; i < starts_m.size(); ++i) add_robot(starts_m[i], {goals_m.at(i)}, team);
}

Scenario CrowdFloor::finish() {
  rng_.shuffle(scenario_.robots);
  for (std::size_t i = 0; i < scenario_.robots.size(); ++i) scenario_.robots[i].id = static_cast<RobotId>(i);
  return scenario_;
}

}  // namespace sidestep
