// SPDX-License-Identifier: Apache-2.0
#include "deploy/study/safety_study.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <unistd.h>
#include <vector>

#include "deploy/study/traversal.hpp"

using namespace sidestep;

namespace {

using Row = std::map<std::string, std::string>;

struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sidestep-study-" + std::to_string(getpid()));
  ~Folder() { std::filesystem::remove_all(path); }
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// The rows of a table by the names of its columns; the lines of its head must be there.
std::vector<Row> read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  CHECK(line.starts_with("# sidestep study safety --out "));
  CHECK(line.find("--seed 7") != std::string::npos);
  std::getline(stream, line);
  CHECK(line.starts_with("# commit "));
  std::getline(stream, line);
  const std::vector<std::string> names = split(line);
  std::vector<Row> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = split(line);
    REQUIRE(cells.size() == names.size());
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
    rows.push_back(row);
  }
  return rows;
}

/// The sum of a column over the rows that have this value in that other column.
double sum(const std::vector<Row>& rows, const std::string& column, const std::string& where,
           const std::string& is) {
  double total = 0;
  std::size_t count = 0;
  for (const Row& row : rows) {
    if (row.at(where) != is) continue;
    total += std::stod(row.at(column));
    ++count;
  }
  CAPTURE(column, where, is);
  REQUIRE(count > 0);
  return total;
}

bool is_png(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char begin[8] = {};
  stream.read(begin, sizeof begin);
  return std::string(begin, sizeof begin) == "\x89PNG\r\n\x1a\n";
}

}  // namespace

TEST_CASE("the quick study shows what the safety search and the margin are good for") {
  Folder folder;
  StudyOptions options;
  options.folder = folder.path;
  options.seed = 7;
  options.is_quick = true;
  REQUIRE(study_safety(options) == 0);

  const auto traversals = read(folder.path / "traversals.csv");
  CHECK(sum(traversals, "penetration_m_s", "mode", "without") > 0.01);
  CHECK(sum(traversals, "contacts", "mode", "without") > 0);
  CHECK(sum(traversals, "penetration_m_s", "mode", "with") == 0);
  CHECK(sum(traversals, "contacts", "mode", "with") == 0);
  CHECK(sum(traversals, "traversals", "mode", "with") > 0);

  const auto margins = read(folder.path / "margins.csv");
  CHECK(sum(margins, "penetration_m_s", "margin_mm", "0") >
        sum(margins, "penetration_m_s", "margin_mm", "10"));
  for (const Row& row : margins) {
    const bool is_as_assumed = row.at("odometry") == "usual" && row.at("noise_mm") == "0.5";
    if (is_as_assumed && row.at("margin_mm") == "10") CHECK(std::stod(row.at("penetration_m_s")) == 0);
  }

  const auto times = read(folder.path / "search.csv");
  CHECK(times.size() == 3 * 5);
  for (const Row& row : times) CHECK(std::stod(row.at("search_us_per_robot")) > 0);
  for (const char* plot : {"traversals.png", "margins.png", "search.png"}) {
    CAPTURE(plot);
    CHECK(is_png(folder.path / plot));
  }
}

TEST_CASE("robots that nobody holds back traverse as fast as their limits allow") {
  TraversalSettings settings;
  settings.robots = 1;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    const Scenario scenario = traversal_scenario(settings, seed);
    const RobotSpec& robot = scenario.robots.front();
    const double way_m = (robot.goals.front().position_m - robot.start_m).norm();
    // To full speed and back takes (v/F + v/D), and half of v times that as a way.
    const double ramps_s = scenario.limits.speed_mps *
                           (1 / scenario.limits.acceleration_mps2 + 1 / scenario.limits.deceleration_mps2);
    const double straight_s = ramps_s / 2 + way_m / scenario.limits.speed_mps;
    const auto result = traverse_without_search(scenario, 10 * straight_s);
    CHECK(result.traversals >= 8);
    CHECK(result.traversals <= 10);
    CHECK(result.reference_error_m < 0.003);
    CHECK(result.contacts == 0);
  }
}

TEST_CASE("the same seed gives the same floor, another one another") {
  const Scenario a = traversal_scenario({}, 5), b = traversal_scenario({}, 5), c = traversal_scenario({}, 6);
  REQUIRE(a.robots.size() == 8);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < a.robots.size(); ++i) {
    CHECK(a.robots[i].start_m == b.robots[i].start_m);
    moved += a.robots[i].start_m != c.robots[i].start_m;
    for (std::size_t j = 0; j < i; ++j) CHECK((a.robots[i].start_m - a.robots[j].start_m).norm() > 0.4);
  }
  CHECK(moved > 0);
}
