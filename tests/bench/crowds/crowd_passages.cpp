// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_passages.hpp"

#include <array>
#include <numbers>
#include <stdexcept>

namespace sidestep {
namespace {

/// Distance from the passage at which nobody at rest can block its mouth.
constexpr double kMouth_m = 0.4;
constexpr double kPillarRadius_m = 0.15;

/// A passage along x.
struct Passage {
  double width_m = 0, length_m = 0, centre_y_m = 0;
};

Passage random_passage(const PassageSettings& settings, Rng& rng) {
  const double width_m = rng.uniform(settings.width.min_m, settings.width.max_m);
  const double length_m = rng.uniform(settings.length.min_m, settings.length.max_m);
  return {width_m, length_m, rng.uniform(-settings.max_shift_m, settings.max_shift_m)};
}

/// Adds a wall along y with the passage in it.
void add_wall(CrowdFloor& floor, const Passage& passage) {
  const double half_length_m = passage.length_m / 2, half_width_m = floor.field().width_m / 2;
  const double below_m = passage.centre_y_m - passage.width_m / 2, above_m = below_m + passage.width_m;
  floor.add_obstacle(Box{{-half_length_m, -half_width_m}, {half_length_m, below_m}});
  floor.add_obstacle(Box{{-half_length_m, above_m}, {half_length_m, half_width_m}});
}

/// Adds the same with pillars, whose inner sides are the door. Their thickness is the length of the passage.
void add_wall_with_pillars(CrowdFloor& floor, const Passage& passage) {
  const double half_width_m = floor.field().width_m / 2, half_wall_m = passage.length_m / 2;
  const double offset_m = passage.width_m / 2 + kPillarRadius_m;
  const double below_m = passage.centre_y_m - offset_m, above_m = passage.centre_y_m + offset_m;
  floor.add_obstacle(Circle{{0, below_m}, kPillarRadius_m});
  floor.add_obstacle(Box{{-half_wall_m, -half_width_m}, {half_wall_m, below_m}});
  floor.add_obstacle(Circle{{0, above_m}, kPillarRadius_m});
  floor.add_obstacle(Box{{-half_wall_m, above_m}, {half_wall_m, half_width_m}});
}

void add_two_sides(CrowdFloor& floor, const PassageSettings& settings, double passage_length_m) {
  const double near_m = passage_length_m / 2 + kMouth_m, half_width_m = settings.rest_width_m / 2;
  const Box right{{near_m, -half_width_m}, {near_m + settings.rest_length_m, half_width_m}};
  const Box left{{-right.max_m.x(), -half_width_m}, {-right.min_m.x(), half_width_m}};
  if ((floor.robot_area().max_m - right.max_m).minCoeff() < 0)
    throw std::invalid_argument("the field is too small for its passage and robots");
  const auto swap_sides = [&](const Box& from, const Box& to, Team team) {
    const auto starts_m = floor.random_places(settings.robots_per_side, from);
    floor.add_robots(starts_m, floor.random_goals(starts_m, to), team);
  };
  swap_sides(left, right, Team::kBlue);
  swap_sides(right, left, Team::kYellow);
}

/// The arms of a junction; arm i points in the direction i · 90°.
constexpr std::size_t kArms = 4, kRobotsPerArm = 2;
/// Distances of the robots at rest in an arm from the middle of the junction, and their maximum deviation.
constexpr std::array<double, kRobotsPerArm> kRest_m{1.3, 2};
constexpr double kRestDeviation_m = 0.15;

/// The places at rest in all arms. Places 2 i and 2 i + 1 lie in arm i.
std::vector<Vec2> arm_places(double max_lateral_m, Rng& rng) {
  std::vector<Vec2> places_m;
  for (std::size_t arm = 0; arm < kArms; ++arm) {
    for (const double rest_m : kRest_m) {
      const double along_m = rest_m + rng.uniform(-kRestDeviation_m, kRestDeviation_m);
      const Vec2 place_m(along_m, rng.uniform(-max_lateral_m, max_lateral_m));
      places_m.push_back(rotated(place_m, static_cast<double>(arm) * std::numbers::pi / 2));
    }
  }
  return places_m;
}

/// A random order of the places in which no robot stays in its arm.
std::vector<std::size_t> other_arms(Rng& rng) {
  std::vector<std::size_t> places(kArms * kRobotsPerArm);
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
  const auto stays = [&] {
    for (std::size_t i = 0; i < places.size(); ++i)
      if (places[i] / kRobotsPerArm == i / kRobotsPerArm) return true;
    return false;
  };
  do rng.shuffle(places);
  while (stays());
  return places;
}

}  // namespace

Scenario passage_scene(const PassageSettings& settings, const Field& field, Rng& rng) {
  CrowdFloor floor(field, rng);
  const Passage passage = random_passage(settings, rng);
  add_wall(floor, passage);
  add_two_sides(floor, settings, passage.length_m);
  return floor.finish();
}

Scenario doorway_scene(const PassageSettings& settings, const Field& field, Rng& rng) {
  CrowdFloor floor(field, rng);
  const Passage passage = random_passage(settings, rng);
  rng.chance(0.5) ? add_wall(floor, passage) : add_wall_with_pillars(floor, passage);
  add_two_sides(floor, settings, passage.length_m);
  return floor.finish();
}

Scenario junction_scene(const LengthRange& width, const Field& field, Rng& rng) {
  CrowdFloor floor(field, rng);
  const double half_m = rng.uniform(width.min_m, width.max_m) / 2;
  const Vec2 corner_m(field.length_m / 2, field.width_m / 2);
  for (const double y_sign : {-1.0, 1.0}) {
    for (const double x_sign : {-1.0, 1.0}) {
      const Vec2 inner_m(x_sign * half_m, y_sign * half_m);
      const Vec2 outer_m(x_sign * corner_m.x(), y_sign * corner_m.y());
      floor.add_obstacle(Box{inner_m.cwiseMin(outer_m), inner_m.cwiseMax(outer_m)});
    }
  }
  const Scenario defaults;
  const double max_lateral_m = half_m - defaults.radius_m - 2 * defaults.margin_m;
  const std::vector<Vec2> starts_m = arm_places(max_lateral_m, rng), goals_m = arm_places(max_lateral_m, rng);
  const std::vector<std::size_t> goals = other_arms(rng);
  for (std::size_t i = 0; i < starts_m.size(); ++i) {
    const bool is_along_x = i / kRobotsPerArm % 2 == 0;
    floor.add_robot(starts_m[i], {goals_m[goals[i]]}, is_along_x ? Team::kBlue : Team::kYellow);
  }
  return floor.finish();
}

}  // namespace sidestep
