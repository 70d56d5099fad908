// SPDX-License-Identifier: Apache-2.0
// Times and errors of E*, compared with a plain wavefront and exact
// lengths. Fails if a field is wrong.
#include <cstdio>
#include <ctime>

#include "agents/planning/grids/navigation/descent.hpp"
#include "common/random/rng.hpp"
#include "tests/bench/exact_lengths.hpp"
#include "tests/bench/plain_wavefront.hpp"

using namespace sidestep;

namespace {

constexpr std::uint64_t kSeed = 1;

double processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

template <typename Run>
double time_ms(const Run& run) {
  const double begin = processor_ms();
  run();
  return processor_ms() - begin;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A square grid with random blocked cells, and a goal in the middle of the cell at a tenth of its side.
struct Problem {
  CostGrid grid;
  Vec2 goal_m;

  Problem(std::uint32_t side, double blocked) : grid({.columns = side, .rows = side}) {
    const GridCell goal = grid.layout().cell(side / 10, side / 10);
    goal_m = grid.layout().centre_of(goal);
    Rng rng(kSeed);
    for (GridCell cell = 0; cell < grid.layout().size(); ++cell)
      if (rng.chance(blocked) && cell != goal) grid.block(cell);
  }
};

template <typename A, typename B>
std::size_t count_differences(const Problem& problem, const A& a, const B& b) {
  std::size_t count = 0;
  for (GridCell cell = 0; cell < problem.grid.layout().size(); ++cell)
    count += a.value(cell) != b.value(cell);
  return count;
}

/// Times a full field; returns E*'s time per cell in nanoseconds.
double compare_full(const Problem& problem, double blocked, int rounds, bool& is_right) {
  const GridLayout& layout = problem.grid.layout();
  EStar field(problem.grid);
  field.set_goal(problem.goal_m);
  PlainWavefront plain(problem.grid);
  std::vector<PlainWavefront::Start> starts;
  for (GridCell cell = 0; cell < layout.size(); ++cell)
    if (field.exact_value(cell) < kBlocked) starts.push_back({cell, field.exact_value(cell)});
  const auto run_estar = [&] {
    field.set_goal(problem.goal_m);
    field.propagate();
  };
  const auto run_plain = [&] { plain.propagate(starts); };
  run_estar();
  run_plain();
  is_right = count_differences(problem, field, plain) == 0 && is_right;
  std::vector<double> estar_ms, plain_ms;
  Rng rng(kSeed);
  for (int round = 0; round < rounds; ++round) {
    const bool plain_first = rng.chance(0.5);
    if (plain_first) plain_ms.push_back(time_ms(run_plain));
    estar_ms.push_back(time_ms(run_estar));
    if (!plain_first) plain_ms.push_back(time_ms(run_plain));
  }
  const double ns = median(estar_ms) * 1e6 / static_cast<double>(layout.size());
  std::printf("%6u %8.0f %% %10.1f %8.1f %8.2f %8.1f\n", layout.columns, 100 * blocked, median(estar_ms),
              median(plain_ms), median(estar_ms) / median(plain_ms), ns);
  return ns;
}

/// Ten cells in a row at right angles to the direction from the goal; empty if they do not fit into the grid.
std::vector<GridCell> wall_at(const Problem& problem, double distance, double angle_rad) {
  const GridLayout& layout = problem.grid.layout();
  const Vec2 along(std::cos(angle_rad), std::sin(angle_rad));
  const Vec2 across = std::abs(along.x()) > std::abs(along.y()) ? Vec2(0, 1) : Vec2(1, 0);
  std::vector<GridCell> wall;
  for (int i = -5; i < 5; ++i) {
    const auto cell = layout.cell_at(problem.goal_m + layout.resolution_m * (distance * along + i * across));
    if (!cell) return {};
    wall.push_back(*cell);
  }
  return wall;
}

struct Replanning {
  double ms = 0;
  std::vector<double> times_ms;
};

/// Inserts and removes walls, and compares the updated fields with recomputed ones.
void compare_replanning(const Problem& problem, double blocked, double full_ns, bool& is_right) {
  EStar field(problem.grid), fresh(problem.grid);
  field.set_goal(problem.goal_m);
  field.propagate();
  const EStar before = field;
  Rng rng(kSeed);
  for (const int distance : {5, 50, 200}) {
    Replanning insert, remove;
    std::size_t changed = 0;
    for (int walls = 0; walls < 40;) {
      const std::vector<GridCell> wall =
          wall_at(problem, distance, rng.uniform(-std::numbers::pi, std::numbers::pi));
      if (wall.empty()) continue;
      ++walls;
      const auto replan = [&](bool block, Replanning& times) {
        for (const GridCell cell : wall) field.set_cost(cell, block ? kBlocked : problem.grid.cost(cell));
        times.times_ms.push_back(time_ms([&] { field.propagate(); }));
        times.ms += times.times_ms.back();
      };
      replan(true, insert);
      changed += count_differences(problem, field, before);
      for (const GridCell cell : wall) fresh.set_cost(cell, kBlocked);
      fresh.set_goal(problem.goal_m);
      fresh.propagate();
      for (const GridCell cell : wall) fresh.set_cost(cell, problem.grid.cost(cell));
      is_right = count_differences(problem, field, fresh) == 0 && is_right;
      replan(false, remove);
      is_right = count_differences(problem, field, before) == 0 && is_right;
    }
    const auto cells = static_cast<double>(changed);
    std::printf("%6.0f %% %9d %12.0f %10.2f %8.1f %8.2f %10.2f %8.1f %8.2f\n", 100 * blocked, distance,
                cells / 40, median(insert.times_ms), insert.ms * 1e6 / cells,
                insert.ms * 1e6 / cells / full_ns, median(remove.times_ms), remove.ms * 1e6 / cells,
                remove.ms * 1e6 / cells / full_ns);
  }
}

struct Variant {
  const char* name;
  EStarSettings settings;
};
constexpr Variant kVariants[] = {{"NF1", {GridKernel::kNf1, 0}},
                                 {"alpha", {GridKernel::kAlpha, 0}},
                                 {"LSM", {GridKernel::kLsm, 0}},
                                 {"LSM, exact 20", {GridKernel::kLsm, 20}},
                                 {"second order", {GridKernel::kSecondOrderLsm, 0}},
                                 {"second order, exact 20", {GridKernel::kSecondOrderLsm, 20}},
                                 {"line of sight", {GridKernel::kLineOfSight, 0}}};

/// A reachable cell and the exact length of its shortest path to the goal, in cells.
struct Sample {
  GridCell cell;
  double length;
};

std::vector<Sample> sample_cells(const Problem& problem, bool is_free, std::size_t count) {
  const GridLayout& layout = problem.grid.layout();
  EStar field(problem.grid);
  field.set_goal(problem.goal_m);
  field.propagate();
  std::vector<Sample> samples;
  const auto distance = [&](GridCell cell) {
    return (layout.centre_of(cell) - problem.goal_m).norm() / layout.resolution_m;
  };
  if (is_free) {
    for (GridCell cell = 0; cell < layout.size(); ++cell) samples.push_back({cell, distance(cell)});
    return samples;
  }
  const ExactLengths exact(problem.grid, problem.goal_m);
  Rng rng(kSeed);
  while (samples.size() < count) {
    const auto cell = static_cast<GridCell>(rng.below(layout.size()));
    if (field.value(cell) < kBlocked) samples.push_back({cell, exact.length(layout.centre_of(cell))});
  }
  return samples;
}

double length_of(const std::vector<Vec2>& path_m) {
  double length_m = 0;
  for (std::size_t i = 1; i < path_m.size(); ++i) length_m += (path_m[i] - path_m[i - 1]).norm();
  return length_m;
}

/// Compares values, and lengths of traced paths, with exact lengths. No path may be shorter than the exact
/// length.
void compare_lengths(const Problem& problem, double blocked, bool& is_right) {
  const GridLayout& layout = problem.grid.layout();
  const std::vector<Sample> samples = sample_cells(problem, blocked == 0, 300);
  const std::size_t every = std::max<std::size_t>(samples.size() / 300, 1);
  for (const Variant& variant : kVariants) {
    EStar field(problem.grid, variant.settings);
    const double ms = time_ms([&] {
      field.set_goal(problem.goal_m);
      field.propagate();
    });
    double sum = 0, largest = 0, ratios = 0, traced = 0;
    std::vector<Vec2> path;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto& [cell, length] = samples[i];
      const double error = std::abs(static_cast<double>(field.value(cell)) - length);
      sum += error;
      largest = std::max(largest, error);
      if (i % every != 0 || length < 1) continue;
      const bool arrives = trace(field, layout.centre_of(cell), path);
      const double ratio = length_of(path) / layout.resolution_m / length;
      is_right = arrives && ratio > 1 - 1e-6 && is_right;
      ratios += ratio;
      ++traced;
    }
    std::printf("%6.0f %% %-24s %8.2f %8.2f %12.4f %8.1f\n", 100 * blocked, variant.name,
                sum / static_cast<double>(samples.size()), largest, ratios / traced, ms);
  }
}

}  // namespace

int main() {
  bool is_right = true;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::printf("Full fields: medians of processor time; goal at a tenth of the side, random blocked cells.\n");
  std::printf("  side  obstacles    E*, ms    plain    ratio  ns/cell\n");
  double full_ns[2] = {};
  for (const std::uint32_t side : {500u, 2000u}) {
    for (const int blocked : {0, 1}) {
      const double ns =
          compare_full(Problem(side, 0.2 * blocked), 0.2 * blocked, side == 500 ? 31 : 9, is_right);
      if (side == 500) full_ns[blocked] = ns;
    }
  }
  std::printf("\nReplanning, side 500: 40 walls of ten cells in random directions, inserted and removed.\n");
  std::printf("Per changed cell: in ns, and over the full field's time per cell.\n");
  std::printf("obstacles distance changed cells insert, ms       ns    ratio remove, ms       ns    ratio\n");
  for (const int blocked : {0, 1})
    compare_replanning(Problem(500, 0.2 * blocked), 0.2 * blocked, full_ns[blocked], is_right);
  std::printf(
      "\nErrors, side 1000, of values over exact lengths: all cells, or 300 random ones among obstacles "
      "(a\n");
  std::printf(
      "point among blocked squares). Paths: mean length of 300 traced paths over the exact length.\n");
  std::printf("obstacles kernel                   mean, cells  max   paths/exact       ms\n");
  for (const int blocked : {0, 1}) compare_lengths(Problem(1000, 0.2 * blocked), 0.2 * blocked, is_right);
  if (!is_right)
    std::printf(
        "\nWRONG: a field differs from the plain wavefront or a recomputed field, or a path is too short.\n");
  return is_right ? 0 : 1;
}
