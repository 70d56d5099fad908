// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/figure_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

#include "common/file/console.hpp"

namespace sidestep {

namespace {

constexpr int kDecisive = 2;  // runs that agree

}  // namespace

FigureTable::FigureTable(const std::string& title, Rule rule) : title_(title), rule_(rule) {
  print_to(stdout, "{}\n", title_);
}

bool FigureTable::is_open(const std::string& name) const {
  const auto row = std::ranges::find(rows_, name, &Row::name);
  return rule_ == Rule::kTwoOfThree && row != rows_.end() && row->missed > 0 && !row->has_failed &&
         row->missed < kDecisive && row->runs - row->missed < kDecisive;
}

void FigureTable::add(const MeasuredRun& run) {
  auto row = std::ranges::find(rows_, run.row, &Row::name);
  if (row == rows_.end()) row = rows_.insert(rows_.end(), Row{.name = run.row, .latest_miss = {}});
  ++row->runs;
  if (!run.misses.empty()) {
    ++row->missed;
    row->has_failed |= !run.may_be_chance;
    row->latest_miss = run.misses.front();
  }
  print_to(stdout, "{:<44} {:<8} {}{}{}\n{}", run.row, run.misses.empty() ? "met" : "MISSED", run.figures,
           run.misses.empty() ? "" : "; missed: ", fmt::join(run.misses, "; "), run.details);
}

void FigureTable::print() const {
  print_to(stdout, "\n{}\n{:<44} {:>5} {:>7}\n", title_, "", "runs", "missed");
  for (const Row& row : rows_)
    print_to(stdout, "{:<44} {:>5} {:>7}  {}\n", row.name, row.runs, row.missed, row.latest_miss);
}

int FigureTable::missed() const {
  int sum = 0;
  for (const Row& row : rows_)
    sum += rule_ == Rule::kEachRun ? row.missed : static_cast<int>(row.has_failed || row.missed >= kDecisive);
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
