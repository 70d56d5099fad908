// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/collision_domains.hpp"

#include <algorithm>
#include <numeric>

#include "common/random/rng.hpp"
#include "tests/study/measurement/distribution.hpp"
#include "tests/study/planning/collision_contenders.hpp"

namespace sidestep {
namespace {

struct CollisionDomain {
  const char* name;
  ObstacleLayout layout;
};
constexpr CollisionDomain kCollisionDomains[] = {{"random", ObstacleLayout::kRandom},
                                                 {"grid", ObstacleLayout::kGrid}};
constexpr double kPlotStep = 0.02;  // step of the plotted fraction of queries

/// The times of all queries, for each structure.
std::vector<Distribution> times_by_query(const CollisionProblem& problem, const CollisionDomains& settings,
                                         const std::vector<CollisionContender>& contenders, Rng& order) {
  std::vector<std::vector<Distribution>> rounds(contenders.size());
  for (std::vector<Distribution>& by_query : rounds) by_query.resize(problem.motions.size());
  std::vector<std::size_t> sequence(contenders.size());
  std::iota(sequence.begin(), sequence.end(), 0u);
  for (std::size_t round = 0; round < settings.rounds; ++round) {
    order.shuffle(sequence);
    for (const std::size_t i : sequence)
      for (std::size_t k = 0; k < problem.motions.size(); ++k)
        rounds[i][k].add(contenders[i].repeated_ns(problem.motions[k], settings.repetitions));
  }
  std::vector<Distribution> times(contenders.size());
  for (std::size_t i = 0; i < contenders.size(); ++i)
    for (const Distribution& query : rounds[i]) times[i].add(query.median());
  return times;
}

}  // namespace

StudyTable collision_domains(const CollisionDomains& settings, std::uint64_t seed,
                             const ProgressCallback& progress) {
  StudyTable table;
  table.name = "domains";
  table.columns = {"domain",    "obstacles", "structure", "queries", "touch_percent",
                   "median_ns", "p95_ns",    "p99_ns",    "max_ns"};
  Rng order(seed);
  std::size_t done = 0;
  for (const CollisionDomain& domain : kCollisionDomains) {
    const CollisionProblem problem(settings.obstacles, settings.queries, true, seed, domain.layout);
    const std::vector<CollisionContender> contenders = collision_contenders(problem);
    const std::vector<Distribution> times = times_by_query(problem, settings, contenders, order);
    Plot& plot = table.plots.emplace_back();
    plot = {.title = fmt::format("{} circles, {}", settings.obstacles, domain.name),
            .x_label = "queries at most as slow [%]",
            .y_label = "time of a query [ns]",
            .has_log_y = true};
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const auto touched =
          std::count_if(problem.motions.begin(), problem.motions.end(), contenders[i].touches);
      const double touch_percent = 100 * static_cast<double>(touched) / static_cast<double>(settings.queries);
      const auto ns = [&](double part) { return fmt::format("{:.1f}", times[i].quantile(part)); };
      table.rows.push_back(cells(domain.name, settings.obstacles, contenders[i].name, settings.queries,
                                 fmt::format("{:.1f}", touch_percent), ns(0.5), ns(0.95),
                                 settings.queries >= kMinForP99 ? ns(0.99) : "", ns(1)));
      plot.lines.push_back({contenders[i].name, {}});
      for (double part = 0; part < 1; part += kPlotStep)
        plot.lines[i].points.push_back(plot_point(100 * part, times[i].quantile(part)));
    }
    progress(++done, std::size(kCollisionDomains));
  }
  return table;
}

}  // namespace sidestep
