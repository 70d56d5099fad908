// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/building/building.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <stdexcept>

#include "common/file/folder.hpp"
#include "common/file/write_file.hpp"
#include "common/map/floor_plan.hpp"
#include "common/map/map_file.hpp"
#include "deploy/trial/simulate/campaign/position_sampler.hpp"

namespace sidestep {
namespace {

FloorPlanSettings plan_settings(const std::string& kind) {
  if (kind == kBuildingKinds.front()) return {};
  return {.min_room_m = 12,
          .max_room_m = 30,
          .corridor_m = 3,
          .aisle_m = 1.8,
          .corridor_chance = 0.5,
          .shelves_chance = 1};
}

/// Several times the time to drive through the building once for each goal.
double time_limit_s(const Scenario& scenario, int goals) {
  return 60 + 4 * goals * (scenario.field.length_m + scenario.field.width_m) / scenario.limits.speed_mps;
}

/// Throws std::invalid_argument if the building has too little room.
void require_room(const Scenario& scenario, int robots) {
  constexpr double kRoom_m2 = 1;  // area for each robot, so that random positions are found soon
  const MapGrid& grid = scenario.map->cells().grid();
  long cells = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Vec2 centre(grid.x_m(column) + grid.resolution_m / 2, grid.y_m(row) + grid.resolution_m / 2);
      cells += scenario.map->cells().distance_m(centre, 2 * scenario.radius_m) >= 2 * scenario.radius_m;
    }
  const double room_m2 = static_cast<double>(cells) * grid.resolution_m * grid.resolution_m;
  if (room_m2 < kRoom_m2 * robots)
    throw std::invalid_argument(
        fmt::format("the building has {:.1f} m² for robots, expected {:.0f} m² for {} robots", room_m2,
                    kRoom_m2 * robots, robots));
}

std::string text_of(const Vec2& p) { return fmt::format("[{:.3f}, {:.3f}]", p.x(), p.y()); }

std::string scenario_text(const BuildingOptions& options, const Scenario& scenario,
                          const std::function<void(const std::string&)>& announce) {
  Rng rng(options.seed);
  PositionSampler positions(scenario, rng);
  // One set of positions for the starts and one for each goal. Robots at a set's positions are apart.
  std::vector<std::vector<Vec2>> places;
  for (int i = 0; i <= options.goals; ++i) {
    announce(i == 0 ? "finding starts" : fmt::format("finding goals, {} of {}", i, options.goals));
    std::vector<Vec2> taken;
    for (int robot = 0; robot < options.robots; ++robot) taken.push_back(positions.sample_apart(taken));
    places.push_back(std::move(taken));
  }
  std::string text = fmt::format(
      "# A random building: {}, seed {}\nfield: {{length_m: {}, width_m: {}}}\nmap: map.yaml\n"
      "time_limit_s: {:.0f}\nrobots:\n",
      options.kind, options.seed, scenario.field.length_m, scenario.field.width_m,
      time_limit_s(scenario, options.goals));
  for (std::size_t robot = 0; robot < places.front().size(); ++robot) {
    std::vector<std::string> goals;
    for (std::size_t i = 1; i < places.size(); ++i) goals.push_back(text_of(places[i][robot]));
    text += fmt::format("  - {{id: {}, start_m: {}, goals_m: [{}]}}\n", robot, text_of(places.front()[robot]),
                        fmt::join(goals, ", "));
  }
  return text;
}

}  // namespace

void write_building(const BuildingOptions& options,
                    const std::function<void(const std::string& step)>& on_step) {
  const auto announce = [&](const std::string& step) {
    if (on_step) on_step(step);
  };
  // Creates the folder first, because generating the building takes seconds.
  create_folder(options.folder);
  Scenario scenario;
  const double side_m = options.cells * options.resolution_m;
  scenario.field = {side_m, side_m};
  MapGrid grid;
  grid.columns = grid.rows = options.cells;
  grid.resolution_m = options.resolution_m;
  grid.origin_m = {-side_m / 2, -side_m / 2};
  announce("drawing the floor plan");
  const OccupancyMap map = make_floor_plan(options.seed, grid, plan_settings(options.kind));
  announce("measuring the room for robots");
  scenario.map = std::make_shared<const FloorMap>(map);
  require_room(scenario, options.robots);
  const std::string text = scenario_text(options, scenario, announce);
  announce("writing the files");
  const std::filesystem::path folder(options.folder);
  write_occupancy_map(map, (folder / "map").string());
  write_file((folder / "scenario.yaml").string(), text);
}

}  // namespace sidestep
