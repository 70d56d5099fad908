// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/terrain_structures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

#include "common/random/rng.hpp"
#include "tests/study/measurement/cpu_clock.hpp"
#include "tests/study/measurement/distribution.hpp"
#include "tests/study/planning/fcl_terrain.hpp"
#include "tests/study/planning/terrain_problem.hpp"

namespace sidestep {
namespace {

constexpr std::array kTerrainStructures{"linear", "terrain tree", "FCL mesh", "FCL mesh (exact solver)"};
constexpr std::array kQueries{"collision", "clearance"};
// A clearance with a larger error is wrong. A wrong decision about contact is excused up to this clearance.
constexpr double kTolerance_m = 1e-6;

/// A structure with its answers (0 or 1 for a collision, metres for a clearance) and query times.
struct TerrainContender {
  std::size_t name;
  std::array<std::function<double(const Flight&)>, kQueries.size()> answer;
  std::array<Distribution, kQueries.size()> ns{};
};

template <typename Terrain>
TerrainContender contender(std::size_t name, const std::shared_ptr<Terrain>& terrain) {
  constexpr double kRadius_m = TerrainProblem::kRadius_m;
  return {name,
          {[terrain](const Flight& f) { return terrain->touches(f.from_m, f.to_m, kRadius_m) ? 1.0 : 0.0; },
           [terrain](const Flight& f) { return terrain->clearance_m(f.from_m, f.to_m, kRadius_m); }}};
}

/// TerrainTree with the interface of the other structures.
class BallOverTerrain {
 public:
  explicit BallOverTerrain(const TerrainProblem& problem) : tree_(problem.points_m, problem.triangles) {}
  bool touches(const Vec3& from_m, const Vec3& to_m, double radius_m) const {
    return tree_.touches(from_m, to_m, radius_m);
  }
  double clearance_m(const Vec3& from_m, const Vec3& to_m, double radius_m) const {
    return std::max(0.0, tree_.distance_m(from_m, to_m) - radius_m);
  }

 private:
  TerrainTree tree_;
};

std::vector<TerrainContender> contenders_of(const TerrainProblem& problem, bool has_linear) {
  std::vector<TerrainContender> contenders;
  if (has_linear) contenders.push_back(contender(0, std::make_shared<LinearTerrain>(problem)));
  contenders.push_back(contender(1, std::make_shared<BallOverTerrain>(problem)));
  std::size_t name = 2;
  for (const auto solver : {FclTerrain::Solver::kDefault, FclTerrain::Solver::kExact})
    contenders.push_back(
        contender(name++, std::make_shared<FclTerrain>(problem.points_m, problem.triangles, solver)));
  return contenders;
}

double query_ns(const TerrainProblem& problem, const std::function<double(const Flight&)>& answer) {
  double sum = 0;
  const double begin_us = cpu_us();
  for (const Flight& flight : problem.flights) sum += answer(flight);
  const double end_us = cpu_us();
  asm volatile("" : : "r"(&sum) : "memory");
  return 1e3 * (end_us - begin_us) / static_cast<double>(problem.flights.size());
}

/// The reference's clearances.
std::vector<double> clearances_of(const TerrainProblem& problem) {
  const LinearTerrain linear(problem);
  std::vector<double> clearances_m;
  for (const Flight& flight : problem.flights)
    clearances_m.push_back(linear.clearance_m(flight.from_m, flight.to_m, TerrainProblem::kRadius_m));
  return clearances_m;
}

double percent(std::size_t count, std::size_t of) {
  return 100 * static_cast<double>(count) / static_cast<double>(of);
}

/// Compares a structure's answers with the reference's.
std::vector<std::string> row_of(const TerrainProblem& problem, const std::vector<double>& clearances_m,
                                const TerrainContender& contender, std::size_t query) {
  std::size_t touching = 0, wrong = 0;
  for (std::size_t i = 0; i < problem.flights.size(); ++i) {
    const double answer = contender.answer[query](problem.flights[i]);
    const bool is_collision = query == 0;
    const double expected = is_collision ? (clearances_m[i] == 0 ? 1 : 0) : clearances_m[i];
    const bool is_close_call = is_collision && clearances_m[i] > 0 && clearances_m[i] <= kTolerance_m;
    touching += is_collision ? answer > 0 : answer == 0;
    wrong += std::abs(answer - expected) > kTolerance_m && !is_close_call;
  }
  const Distribution& ns = contender.ns[query];
  const std::size_t queries = problem.flights.size();
  return cells(problem.triangles.size(), kQueries[query], kTerrainStructures[contender.name], queries,
               fmt::format("{:.1f}", percent(touching, queries)),
               fmt::format("{:.1f}", percent(wrong, queries)), fmt::format("{:.0f}", ns.median()),
               fmt::format("{:.0f}", ns.quantile(0)), fmt::format("{:.0f}", ns.quantile(1)));
}

}  // namespace

StudyTable terrain_structures(const TerrainStructures& settings, std::uint64_t seed,
                              const ProgressCallback& progress) {
  StudyTable table;
  table.name = "terrain";
  table.columns = {"triangles",     "query",     "structure", "queries", "touch_percent",
                   "wrong_percent", "median_ns", "min_ns",    "max_ns"};
  for (const char* query : kQueries) {
    Plot& plot = table.plots.emplace_back();
    plot = {.title = fmt::format("A ball over terrain: {}, {} rounds of {}", query, settings.rounds,
                                 settings.queries),
            .x_label = "triangles",
            .y_label = "time of a query [ns]",
            .has_log_x = true,
            .has_log_y = true};
    for (const char* name : kTerrainStructures) plot.lines.push_back({name, {}});
  }
  Rng order(seed);
  std::size_t done = 0;
  for (const std::size_t squares : settings.squares) {
    const TerrainProblem problem(squares, settings.queries, seed);
    std::vector<TerrainContender> contenders =
        contenders_of(problem, problem.triangles.size() <= settings.max_linear_triangles);
    std::vector<std::size_t> sequence(contenders.size());
    std::iota(sequence.begin(), sequence.end(), 0u);
    for (std::size_t round = 0; round < settings.rounds; ++round) {
      order.shuffle(sequence);
      for (const std::size_t i : sequence)
        for (std::size_t query = 0; query < kQueries.size(); ++query)
          contenders[i].ns[query].add(query_ns(problem, contenders[i].answer[query]));
      progress(++done, settings.squares.size() * settings.rounds);
    }
    const std::vector<double> clearances_m = clearances_of(problem);
    for (std::size_t query = 0; query < kQueries.size(); ++query) {
      for (const TerrainContender& contender : contenders) {
        table.rows.push_back(row_of(problem, clearances_m, contender, query));
        const Distribution& ns = contender.ns[query];
        table.plots[query].lines[contender.name].points.push_back(
            {static_cast<double>(problem.triangles.size()), ns.median(), ns.quantile(0), ns.quantile(1)});
      }
    }
  }
  return table;
}

}  // namespace sidestep
