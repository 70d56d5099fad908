// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/figure_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

#include "common/file/console.hpp"

namespace sidestep {

FigureTable::FigureTable(const std::string& title, Judged judged) : title_(title), judged_(judged) {
  print_to(stdout, "{}\n", title_);
}

bool FigureTable::is_open(const std::string& name) const {
  constexpr int kMaxRuns = 3;
  const auto row = std::ranges::find(rows_, name, &Row::name);
  return judged_ == Judged::kMajority && row != rows_.end() && row->missed > 0 && row->runs < kMaxRuns;
}

void FigureTable::add(const MeasuredRun& run) {
  auto row = std::ranges::find(rows_, run.row, &Row::name);
  if (row == rows_.end()) row = rows_.insert(rows_.end(), Row{.name = run.row, .latest_miss = {}});
  ++row->runs;
  row->is_unsafe |= run.is_unsafe;
  if (!run.misses.empty()) {
    ++row->missed;
    row->latest_miss = run.misses.front();
  }
  print_to(stdout, "{:<44} {:<8} {}{}{}\n", run.row, run.misses.empty() ? "met" : "MISSED", run.figures,
           run.misses.empty() ? "" : "; missed: ", fmt::join(run.misses, "; "));
}

void FigureTable::print() const {
  print_to(stdout, "\n{}\n{:<44} {:>5} {:>7}\n", title_, "", "runs", "missed");
  for (const Row& row : rows_)
    print_to(stdout, "{:<44} {:>5} {:>7}  {}\n", row.name, row.runs, row.missed, row.latest_miss);
}

int FigureTable::missed() const {
  int sum = 0;
  for (const Row& row : rows_) {
    const bool is_row_missed = row.is_unsafe || 2 * row.missed > row.runs;
    sum += judged_ == Judged::kEachRun ? row.missed : static_cast<int>(is_row_missed);
  }
  return sum;
}

int runs_from_environment(const char* name, int otherwise) {
  const char* const text = std::getenv(name);
  if (!text) return otherwise;
  char* end = nullptr;
  const long runs = std::strtol(text, &end, 10);
  if (end == text || *end != '\0' || runs < 0 || runs > 100'000)
    throw std::invalid_argument(fmt::format("{}: expected a number of runs, got \"{}\"", name, text));
  return static_cast<int>(runs);
}

}  // namespace sidestep
