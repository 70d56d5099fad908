// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/collision_structures.hpp"

#include <algorithm>
#include <numeric>

#include "common/random/rng.hpp"
#include "tests/study/measurement/distribution.hpp"
#include "tests/study/planning/collision_contenders.hpp"

namespace sidestep {
namespace {

// The number of obstacles in the domains of the thesis (Bruce 2006), marked in the plot.
constexpr double kMarkedObstacles = 64;

/// Measures each structure in rounds. In each round all structures get the same queries, in shuffled order.
std::vector<Distribution> query_times(const std::vector<CollisionContender>& contenders, std::size_t rounds,
                                      Rng& order) {
  std::vector<Distribution> ns(contenders.size());
  std::vector<std::size_t> sequence(contenders.size());
  std::iota(sequence.begin(), sequence.end(), 0u);
  for (std::size_t round = 0; round < rounds; ++round) {
    order.shuffle(sequence);
    for (const std::size_t i : sequence) ns[i].add(contenders[i].query_ns());
  }
  return ns;
}

}  // namespace

StudyTable collision_structures(const CollisionStructures& settings, std::uint64_t seed,
                                const ProgressCallback& progress) {
  StudyTable table;
  table.name = "collision";
  table.columns = {"obstacles", "structure", "queries", "touch_percent", "median_ns", "min_ns", "max_ns"};
  table.plots = {{.title = fmt::format("A swept disc among circles, {} rounds of {} queries", settings.rounds,
                                       settings.queries),
                  .x_label = "obstacles",
                  .y_label = "time of a query [ns]",
                  .has_log_x = true,
                  .has_log_y = true,
                  .marked_x = kMarkedObstacles}};
  std::vector<PlotLine>& lines = table.plots[0].lines;
  Rng order(seed);
  std::size_t done = 0;
  for (const std::size_t obstacles : settings.obstacles) {
    const CollisionProblem problem(obstacles, settings.queries, true, seed);
    const std::vector<CollisionContender> contenders = collision_contenders(problem);
    const std::vector<Distribution> ns = query_times(contenders, settings.rounds, order);
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const auto touched =
          std::count_if(problem.motions.begin(), problem.motions.end(), contenders[i].touches);
      const double touch_percent = 100 * static_cast<double>(touched) / static_cast<double>(settings.queries);
      table.rows.push_back(cells(obstacles, contenders[i].name, settings.queries,
                                 fmt::format("{:.3f}", touch_percent), fmt::format("{:.1f}", ns[i].median()),
                                 fmt::format("{:.1f}", ns[i].quantile(0)),
                                 fmt::format("{:.1f}", ns[i].quantile(1))));
      if (i == lines.size()) lines.push_back({contenders[i].name, {}});
      lines[i].points.push_back(
          {static_cast<double>(obstacles), ns[i].median(), ns[i].quantile(0), ns[i].quantile(1)});
    }
    progress(++done, settings.obstacles.size());
  }
  return table;
}

}  // namespace sidestep
