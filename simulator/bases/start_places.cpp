// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/start_places.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

constexpr double kSpacing_m = 0.3;

// Blue robots stand left of the field's centre and yellow robots right of it, by their numbers in the team.
void place_in_line(BaseWorld& world) {
  const Scenario& floor = world.floor();
  const double y_m = floor.field.width_m / 2 - 1.2 * floor.radius_m;
  for (std::size_t i = 0; i < floor.robots.size(); ++i) {
    if (!world.bodies()[i].is_on_floor()) continue;
    const RobotSpec& robot = floor.robots[i];
    const double side = robot.team == Team::kBlue ? -1 : 1;
    const Vec2 place_m(side * kSpacing_m * (number_in_team(robot.id) + 0.5), y_m);
    if (!floor.field.contains(place_m, floor.radius_m))
      throw std::invalid_argument(fmt::format(
          "--starts line: robot {} would stand at ({:.2f}, {:.2f}), outside the field of scenario {}",
          robot.id, place_m.x(), place_m.y(), floor.name));
    world.place(i, place_m, world.bodies()[i].heading_rad());
  }
}

void shuffle_places(BaseWorld& world, std::uint64_t seed) {
  std::vector<std::size_t> order;
  std::vector<Vec2> places_m;
  for (std::size_t i = 0; i < world.scenario_robot_count(); ++i) {
    if (world.bodies()[i].is_on_floor()) order.push_back(i);
  }
  Rng rng(seed);
  rng.shuffle(order);
  for (const std::size_t robot : order) places_m.push_back(world.bodies()[robot].position_m());
  for (std::size_t k = 0; k < order.size(); ++k)
    world.place(order[k], places_m[(k + 1) % order.size()], world.bodies()[order[k]].heading_rad());
}

}  // namespace

void place_robots(BaseWorld& world, StartPlaces places, std::uint64_t seed) {
  if (places == StartPlaces::kLine) place_in_line(world);
  if (places == StartPlaces::kShuffled) shuffle_places(world, seed);
}

}  // namespace sidestep
