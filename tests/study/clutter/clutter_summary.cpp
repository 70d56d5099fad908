// SPDX-License-Identifier: Apache-2.0
#include "tests/study/clutter/clutter_summary.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace sidestep {
namespace {

/// The cells of a row by the names of their columns.
class NamedRow {
 public:
  NamedRow(const StudyTable& table, const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) cells_[table.columns[i]] = cells[i];
  }
  const std::string& text(const std::string& column) const { return cells_.at(column); }
  double number(const std::string& column) const { return std::stod(cells_.at(column)); }

 private:
  std::map<std::string, std::string> cells_;
};

/// All runs of one planner among the same number of people.
struct Group {
  std::string planner;
  int people = 0;
  std::vector<double> seconds;
  double robots = 0, arrived = 0, contacts = 0, crashes = 0, crashes_in_motion = 0;

  void add(const NamedRow& row) {
    seconds.push_back(row.number("seconds"));
    robots += row.number("robots");
    arrived += row.number("arrived");
    contacts += row.number("contacts");
    crashes += row.number("crashes");
    crashes_in_motion += row.number("crashes_in_motion");
  }
};

}  // namespace

StudyTable clutter_summary(const StudyTable& runs) {
  std::vector<Group> groups;
  for (const auto& cells : runs.rows) {
    const NamedRow row(runs, cells);
    const std::pair key(row.text("planner"), static_cast<int>(row.number("people")));
    auto group =
        std::ranges::find_if(groups, [&](const Group& g) { return std::pair(g.planner, g.people) == key; });
    if (group == groups.end()) group = groups.insert(group, Group{key.first, key.second, {}});
    group->add(row);
  }
  StudyTable summary;
  summary.name = runs.name + "_summary";
  summary.columns = {"planner",  "people",    "runs",     "arrived", "robots",
                     "median_s", "longest_s", "contacts", "crashes", "crashes_in_motion"};
  for (const Group& g : groups) {
    const PlotPoint time = plot_point(g.people, g.seconds);
    summary.rows.push_back(cells(g.planner, g.people, g.seconds.size(), g.arrived, g.robots,
                                 fmt::format("{:.1f}", time.median), fmt::format("{:.1f}", time.max),
                                 g.contacts, g.crashes, g.crashes_in_motion));
  }
  return summary;
}

Plot success_plot(const StudyTable& summary) {
  Plot plot{"robots that reach all goals", "people", "share of the robots"};
  for (const auto& cells : summary.rows) {
    const NamedRow row(summary, cells);
    const auto line = std::ranges::find(plot.lines, row.text("planner"), &PlotLine::title);
    PlotLine& of_planner =
        line == plot.lines.end() ? plot.lines.emplace_back(PlotLine{row.text("planner"), {}}) : *line;
    of_planner.points.push_back(
        plot_point(row.number("people"), row.number("arrived") / row.number("robots")));
  }
  return plot;
}

}  // namespace sidestep
