// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/study/study_files.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <unistd.h>

#include "tests/catch.hpp"

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

StudyFolder::StudyFolder()
    : path_(std::filesystem::temp_directory_path() / ("sidestep-study-" + std::to_string(getpid()))) {}

StudyFolder::~StudyFolder() { std::filesystem::remove_all(path_); }

std::vector<StudyRow> StudyFolder::table(const std::string& study, const std::string& name,
                                         std::uint64_t seed) const {
  CAPTURE(study, name, seed);
  std::ifstream stream(path_ / (name + ".csv"));
  std::string line;
  std::getline(stream, line);
  CHECK(line.starts_with("# sidestep study " + study + " --out "));
  CHECK(line.find("--seed " + std::to_string(seed)) != std::string::npos);
  std::getline(stream, line);
  CHECK(line.starts_with("# commit "));
  std::getline(stream, line);
  const std::vector<std::string> names = split(line);
  std::vector<StudyRow> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = split(line);
    REQUIRE(cells.size() == names.size());
    StudyRow& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
  }
  return rows;
}

bool StudyFolder::has_png(const std::string& name) const {
  std::ifstream stream(path_ / (name + ".png"), std::ios::binary);
  char begin[8] = {};
  stream.read(begin, sizeof begin);
  return std::string(begin, sizeof begin) == "\x89PNG\r\n\x1a\n";
}

std::vector<StudyRow> rows_of(const sidestep::StudyTable& table) {
  std::vector<StudyRow> rows;
  for (const auto& cells : table.rows) {
    REQUIRE(cells.size() == table.columns.size());
    StudyRow& row = rows.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) row[table.columns[i]] = cells[i];
  }
  return rows;
}

std::vector<StudyRow> without_timings(std::vector<StudyRow> rows) {
  for (StudyRow& row : rows)
    std::erase_if(
        row, [](const auto& cell) { return cell.first.ends_with("_us") || cell.first.ends_with("_ns"); });
  return rows;
}

double number_in(const std::vector<StudyRow>& rows, const StudyRow& cells, const std::string& column) {
  std::vector<double> found;
  for (const StudyRow& row : rows)
    if (std::all_of(cells.begin(), cells.end(),
                    [&](const auto& cell) { return row.at(cell.first) == cell.second; }))
      found.push_back(std::stod(row.at(column)));
  CAPTURE(cells, column);
  REQUIRE(found.size() == 1);
  return found[0];
}

void check_experiment(const Experiment& experiment) {
  std::size_t last = 0, end = 0;
  const sidestep::StudyTable table = experiment(5, [&](std::size_t done, std::size_t of) {
    CHECK(done == last + 1);
    last = done;
    end = of;
  });
  CHECK(last == end);
  CHECK(last > 0);
  const auto rows = rows_of(table);
  CHECK_FALSE(rows.empty());
  CHECK_FALSE(table.plots.empty());
  for (const sidestep::Plot& plot : table.plots) {
    CHECK_FALSE(plot.lines.empty());
    for (const sidestep::PlotLine& line : plot.lines) CHECK_FALSE(line.points.empty());
  }
  const auto again = [&](std::uint64_t seed) {
    return without_timings(rows_of(experiment(seed, [](auto, auto) {})));
  };
  CHECK(again(5) == without_timings(rows));
  CHECK(again(6) != without_timings(rows));
}

double sum_of(const std::vector<StudyRow>& rows, const std::string& column, const std::string& where,
              const std::string& is) {
  double total = 0;
  std::size_t count = 0;
  for (const StudyRow& row : rows) {
    if (row.at(where) != is) continue;
    total += std::stod(row.at(column));
    ++count;
  }
  CAPTURE(column, where, is);
  REQUIRE(count > 0);
  return total;
}
