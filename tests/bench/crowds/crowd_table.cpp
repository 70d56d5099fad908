// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <optional>

namespace sidestep {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string mean_cell(const Distribution& values) {
  return values.size() > 0 ? fmt::format("{:.2f}", values.mean()) : "-";
}

/// A quantile of the values of all scenes. `values` are those of the complete ones; an incomplete scene is
/// worse than all of them.
std::string quantile_cell(const CrowdScore& score, Distribution values, double fraction) {
  for (int i = 0; i < score.incomplete(); ++i) values.add(kInfinity);
  if (values.size() == 0) return "-";
  const double value = values.quantile(fraction);
  return value < kInfinity ? fmt::format("{:.2f}", value) : "failed";
}

/// The ratio of a row over that of another method in the same family.
std::string over_method(std::span<const CrowdRow> rows, const CrowdRow& row, const char* method) {
  const auto other = std::ranges::find_if(rows, [&](const CrowdRow& candidate) {
    return candidate.family == row.family && candidate.method == method;
  });
  if (other == rows.end()) return "-";
  const auto relative = relative_ratio(row.score, other->score);
  return relative ? fmt::format("{:.2f}", *relative) : "-";
}

std::vector<std::string> row_cells(std::span<const CrowdRow> rows, const CrowdRow& row) {
  const CrowdScore& score = row.score;
  return {row.family,
          row.method,
          row.setting.empty() ? "-" : row.setting,
          fmt::format("{}", score.scenes),
          fmt::format("{}", score.complete.size()),
          fmt::format("{}", score.robots),
          fmt::format("{}", score.arrived),
          fmt::format("{}", score.contacts),
          fmt::format("{}", score.violations),
          mean_cell(score.ratios()),
          quantile_cell(score, score.ratios(), 1),
          quantile_cell(score, score.makespans_s(), 0.5),
          quantile_cell(score, score.makespans_s(), 1),
          fmt::format("{:.1f}", score.cpu_us.mean()),
          over_method(rows, row, kSidestepMethod),
          over_method(rows, row, kReferenceMethod)};
}

/// The names in the rows, each once, in the order of the rows.
std::vector<std::string> names_in(std::span<const CrowdRow> rows, std::string CrowdRow::*name) {
  std::vector<std::string> names;
  for (const CrowdRow& row : rows)
    if (std::ranges::find(names, row.*name) == names.end()) names.push_back(row.*name);
  return names;
}

/// The rows with only those complete scenes that all methods of the family completed. Methods without a
/// complete scene do not count.
std::vector<CrowdRow> rows_of_shared_scenes(std::span<const CrowdRow> rows) {
  std::vector<CrowdRow> shared(rows.begin(), rows.end());
  for (CrowdRow& row : shared) {
    std::erase_if(row.score.complete, [&](const auto& scene) {
      return std::ranges::any_of(rows, [&](const CrowdRow& other) {
        return other.family == row.family && !other.score.complete.empty() &&
               !other.score.complete.contains(scene.first);
      });
    });
  }
  return shared;
}

/// What a plot shows of a score: the height of its bar and its extremes; nullopt: nothing.
struct Bar {
  double value = 0, min = 0, max = 0;
};
using BarOf = std::function<std::optional<Bar>(const CrowdScore&)>;

std::optional<Bar> bar_with_extremes(const Distribution& values, double value) {
  if (values.size() == 0) return std::nullopt;
  return Bar{value, values.quantile(0), values.quantile(1)};
}

std::optional<Bar> bar_per_scene(double total, const CrowdScore& score) {
  const double value = total / score.scenes;
  return Bar{value, value, value};
}

Plot plot_of(std::span<const CrowdRow> rows, const std::string& title, const std::string& y_label,
             const BarOf& bar_of) {
  Plot plot;
  plot.title = title;
  plot.y_label = y_label;
  plot.categories = names_in(rows, &CrowdRow::family);
  for (const std::string& method : names_in(rows, &CrowdRow::method)) {
    PlotLine line{method, {}};
    for (const CrowdRow& row : rows) {
      if (row.method != method) continue;
      const auto bar = bar_of(row.score);
      const auto family = std::ranges::find(plot.categories, row.family) - plot.categories.begin();
      if (bar) line.points.push_back({static_cast<double>(family), bar->value, bar->min, bar->max});
    }
    if (!line.points.empty()) plot.lines.push_back(line);
  }
  return plot;
}

/// The plots, except those that would be empty.
std::vector<Plot> plots_of(std::span<const CrowdRow> rows) {
  const std::vector<CrowdRow> shared = rows_of_shared_scenes(rows);
  std::vector<Plot> plots{
      plot_of(
          shared, "arrival, shared scenes: mean, with extremes", "over the straight line",
          [](const CrowdScore& score) { return bar_with_extremes(score.ratios(), score.ratios().mean()); }),
      plot_of(shared, "makespan, shared scenes: median, with extremes", "time [s]",
              [](const CrowdScore& score) {
                return bar_with_extremes(score.makespans_s(), score.makespans_s().median());
              }),
      plot_of(rows, "robots that do not arrive", "per scene",
              [](const CrowdScore& score) { return bar_per_scene(score.robots - score.arrived, score); }),
      plot_of(
          rows, "contacts", "per scene",
          [](const CrowdScore& score) { return bar_per_scene(static_cast<double>(score.contacts), score); }),
      plot_of(rows, "one robot, one control cycle", "time [us]", [](const CrowdScore& score) {
        return score.cpu_us.mean() > 0 ? bar_with_extremes(score.cpu_us, score.cpu_us.mean()) : std::nullopt;
      })};
  plots.back().has_log_y = true;
  std::erase_if(plots, [](const Plot& plot) { return plot.lines.empty(); });
  return plots;
}

}  // namespace

StudyTable crowd_table(std::span<const CrowdRow> rows) {
  StudyTable table;
  table.name = "crowds";
  table.columns = {"family",           "method", "setting",       "scenes",
                   "complete",         "robots", "arrived",       "contacts",
                   "violations",       "ratio",  "worst_ratio",   "makespan_s",
                   "worst_makespan_s", "cpu_us", "over_sidestep", "over_reference"};
  for (const CrowdRow& row : rows) table.rows.push_back(row_cells(rows, row));
  table.plots = plots_of(rows);
  return table;
}

}  // namespace sidestep
