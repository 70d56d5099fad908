// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/building/building.hpp"

#include <filesystem>
#include <fstream>
#include <queue>
#include <sstream>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::building_test {

struct Folder {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sidestep-building-" + std::to_string(getpid()));
  ~Folder() { std::filesystem::remove_all(path); }

  std::string text(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path / name, std::ios::binary).rdbuf();
    return text.str();
  }
};

BuildingOptions small_building(const Folder& folder) {
  BuildingOptions options;
  options.folder = folder.path.string();
  options.cells = 700;
  return options;
}

/// The cells that a robot can reach from a position, through cells whose centres are far enough from walls
/// for the robot.
class FloodFill {
 public:
  FloodFill(const Scenario& scenario, const Vec2& from) : map_(scenario.map->cells()) {
    const MapGrid& grid = map_.grid();
    reached_.resize(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
    std::queue<Cell> next;
    const auto visit = [&](const Cell& cell) {
      if (!grid.has(cell) || reached_[index(cell)] || map_.distance_m(centre_m(grid.box_of(cell)), 1) < 0.15)
        return;
      reached_[index(cell)] = true;
      next.push(cell);
    };
    for (visit(map_.cell_at(from)); !next.empty(); next.pop()) {
      const Cell at = next.front();
      for (const Cell& step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}})
        visit({at.column + step.column, at.row + step.row});
    }
  }

  /// Whether a cell within 15 cm of `p` can be reached.
  bool reaches_near(const Vec2& p) const {
    const Cell at = map_.cell_at(p);
    for (int column = at.column - 3; column <= at.column + 3; ++column)
      for (int row = at.row - 3; row <= at.row + 3; ++row)
        if (map_.grid().has({column, row}) && reached_[index({column, row})]) return true;
    return false;
  }

 private:
  std::size_t index(const Cell& cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(map_.grid().columns) +
           static_cast<std::size_t>(cell.column);
  }
  const OccupancyMap& map_;
  std::vector<bool> reached_;
};

TEST_CASE("all places of a random building are connected, and robots at different places are apart") {
  const auto kind = GENERATE(from_range(kBuildingKinds));
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 6));
  CAPTURE(kind, seed);
  const Folder folder;
  BuildingOptions options = small_building(folder);
  options.kind = kind;
  options.seed = seed;
  options.robots = 8;
  write_building(options);
  const Scenario scenario = load_scenario((folder.path / "scenario.yaml").string());
  CHECK(scenario.field.length_m == Approx(35));
  REQUIRE(scenario.robots.size() == 8);
  const FloodFill reached(scenario, scenario.robots.front().start_m);
  for (const RobotSpec& robot : scenario.robots) {
    CAPTURE(robot.id);
    REQUIRE(robot.goals.size() == 3);
    CHECK(reached.reaches_near(robot.start_m));
    for (const Goal& goal : robot.goals) CHECK(reached.reaches_near(goal.position_m));
    for (const RobotSpec& other : scenario.robots) {
      if (other.id == robot.id) continue;
      CHECK((other.start_m - robot.start_m).norm() > 2 * scenario.radius_m);
      for (std::size_t i = 0; i < 3; ++i)
        CHECK((other.goals[i].position_m - robot.goals[i].position_m).norm() > 2 * scenario.radius_m);
    }
  }
}

TEST_CASE("the same options give the same building, and a different seed gives a different building") {
  const Folder folder;
  BuildingOptions options = small_building(folder);
  write_building(options);
  const std::string map = folder.text("map.pgm"), scenario = folder.text("scenario.yaml");
  write_building(options);
  CHECK(folder.text("map.pgm") == map);
  CHECK(folder.text("scenario.yaml") == scenario);
  options.seed = 2;
  write_building(options);
  CHECK(folder.text("map.pgm") != map);
}

TEST_CASE("each step of making a building is announced before it begins") {
  const Folder folder;
  BuildingOptions options = small_building(folder);
  options.goals = 2;
  std::vector<std::string> steps;
  write_building(options, [&](const std::string& step) { steps.push_back(step); });
  CHECK(steps == std::vector<std::string>{"drawing the floor plan", "measuring the room for robots",
                                          "finding starts", "finding goals, 1 of 2", "finding goals, 2 of 2",
                                          "writing the files"});
}

TEST_CASE("a building without room for its robots is rejected") {
  const Folder folder;
  BuildingOptions options = small_building(folder);
  options.cells = 100;
  options.resolution_m = 0.02;
  options.robots = 50;
  CHECK_THROWS_WITH(write_building(options), ContainsSubstring("expected 50 m² for 50 robots"));
}

}  // namespace sidestep::building_test
