// SPDX-License-Identifier: Apache-2.0
// Tries each row of the table of simulators in deploy/trial/conformance/README.md on our server with its
// traits: a robot conforms with the row's settings, and eleven robots arrive with them.
#include <fmt/format.h>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/faults/driven_figures.hpp"
#include "tests/faults/foreign_conformance.hpp"

namespace sidestep::simulators_in_use_test {
namespace {

constexpr const char* kSection = "## Simulators in use\n";

struct SimulatorRow {
  std::string name;
  std::vector<std::string> traits;  ///< options of our simulator
  std::vector<std::string> keys;    ///< lines of a scenario
  std::string driver_options;
  std::vector<std::string> conformance_options;
};

/// The parts of a cell that are code.
std::vector<std::string> code_in(const std::string& cell) {
  std::vector<std::string> parts;
  std::istringstream text(cell);
  bool is_code = false;
  for (std::string part; std::getline(text, part, '`'); is_code = !is_code) {
    if (is_code) parts.push_back(part);
  }
  return parts;
}

std::vector<std::string> words_in(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// The words of all options in a cell.
std::vector<std::string> options_in(const std::string& cell) {
  std::vector<std::string> options;
  for (const std::string& option : code_in(cell)) {
    for (const std::string& word : words_in(option)) options.push_back(word);
  }
  return options;
}

/// The rows of the table: name | traits | keys of the scenario | options of sidestep-robot | options of
/// conformance.
std::vector<SimulatorRow> rows_of_readme() {
  const std::string page = shipped("trial/conformance/README.md");
  const auto begin = page.find(kSection);
  REQUIRE(begin != std::string::npos);
  std::istringstream lines(page.substr(begin + std::string(kSection).size()));
  std::vector<SimulatorRow> rows;
  bool is_below_heading = false;
  for (std::string line; std::getline(lines, line) && !line.starts_with("## ");) {
    is_below_heading = is_below_heading || line.starts_with("|---");
    if (!line.starts_with("| ") || !is_below_heading) continue;
    std::vector<std::string> cells;
    std::istringstream text(line.substr(1));
    for (std::string cell; std::getline(text, cell, '|');) cells.push_back(cell);
    REQUIRE(cells.size() == 5);
    SimulatorRow row{cells[0], options_in(cells[1]), code_in(cells[2]), "", options_in(cells[4])};
    for (const std::string& option : code_in(cells[3]))
      row.driver_options += (row.driver_options.empty() ? "" : " ") + option;
    rows.push_back(row);
  }
  return rows;
}

/// A shipped scenario in which the row's keys replace its own.
std::string scenario_of(const SimulatorRow& row, const std::string& name) {
  std::istringstream lines(shipped_scenario(name));
  std::string text;
  const auto key_of = [](const std::string& line) { return line.substr(0, line.find(':') + 1); };
  for (std::string line; std::getline(lines, line);) {
    bool is_replaced = false;
    for (const std::string& key : row.keys) is_replaced = is_replaced || line.starts_with(key_of(key));
    if (!is_replaced) text += line + "\n";
  }
  for (const std::string& key : row.keys) text += key + "\n";
  return text;
}

void try_row(FigureTable& table, const SimulatorRow& row) {
  const std::string examined = row.name + ": conformance", driven = row.name + ": eleven robots";
  measure(table, examined, [&] {
    const auto outcome = examine_foreign_robot(scenario_of(row, "league/lone-robot"), row.traits,
                                               row.driver_options, row.conformance_options);
    MeasuredRun result{examined, outcome.ended + ", " + outcome.latency_row, {}};
    if (outcome.ended != "exit code 0") result.misses.push_back("\n" + outcome.output);
    return result;
  });
  measure(table, driven, [&] {
    ExternalSimulatorRun floor(scenario_of(row, "league/eleven-blue"), row.traits,
                               {"--place", "--robots=" + row.driver_options});
    return drive_to_end(driven, floor);
  });
}

}  // namespace

TEST_CASE("the table of simulators has rows with traits, keys and options of the driver") {
  const auto rows = rows_of_readme();
  CHECK(rows.size() >= 4);
  for (const SimulatorRow& row : rows) {
    INFO(row.name);
    CHECK(row.keys.size() >= 2);
    CHECK_FALSE(row.driver_options.empty());
  }
}

TEST_CASE("with the settings of each simulator in use, a robot conforms and eleven robots arrive",
          "[.long][slow]") {
  const int runs = runs_from_environment("SIDESTEP_SIMULATOR_RUNS", 1);
  FigureTable table("Simulators in use: conformance, and eleven robots with the same settings");
  for (int run = 0; run < runs; ++run) {
    for (const SimulatorRow& row : rows_of_readme()) try_row(table, row);
  }
  table.print();
  CHECK(table.missed() == 0);
}

}  // namespace sidestep::simulators_in_use_test
