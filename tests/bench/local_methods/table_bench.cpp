// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/core.h>
#include <string>

#include "agents/navigation/dynamic_window/dynamic_window.hpp"
#include "agents/navigation/dynamic_window/hull_cell_times.hpp"
#include "tests/bench/local_methods/measurement.hpp"
#include "tests/bench/local_methods/scenes.hpp"
#include "tests/study/measurement/cpu_clock.hpp"

namespace sidestep {
namespace {

/// Measures how far stored times are below exact ones, over all stored cells and allowed velocities that
/// collide within the horizon.
struct TableError {
  double sum_s = 0, sum_ratio = 0, sum_exact_s = 0, worst_s = 0;
  std::size_t entries = 0, too_late = 0;

  void add(double exact_s, double stored_s) {
    const double error_s = exact_s - stored_s;
    if (error_s < 0) ++too_late;
    sum_s += error_s;
    sum_ratio += error_s / exact_s;
    sum_exact_s += exact_s;
    worst_s = std::max(worst_s, error_s);
    ++entries;
  }
  double mean_ratio() const { return sum_ratio / static_cast<double>(entries); }
  void print(const char* name, double bytes) const {
    const auto count = static_cast<double>(entries);
    fmt::print("  {:<44}{:10.2f}{:10.2f}{:12.2f}{:10.2f}{:10.2f}{:10}\n", name, 1e3 * sum_s / count,
               1e3 * worst_s, 100 * mean_ratio(), 100 * sum_s / sum_exact_s, bytes, too_late);
  }
};

/// Compares quantisers with the exact times of cells. `quantiser_of(cell)` is called once for each cell.
template <typename QuantiserOf>
TableError table_error(const CellTimes& cells, const DifferentialDrive& drive, QuantiserOf quantiser_of) {
  TableError error;
  for (std::size_t cell = 0; cell < cells.grid.size(); ++cell) {
    if (cells.touches_hull[cell]) continue;
    const auto times = cells.of(cell);
    if (std::ranges::none_of(times, [&](float t) { return t < cells.horizon_s; })) continue;
    const Quantiser& quantiser = quantiser_of(times);
    for_each_velocity({{0, kGridSide - 1}, {0, kGridSide - 1}}, [&](int row, int column, std::size_t slot) {
      if (times[slot] >= cells.horizon_s || !drive.is_allowed(drive.motion(drive.wheels(row, column))))
        return;
      error.add(static_cast<double>(times[slot]),
                static_cast<double>(quantiser.decode(quantiser.encode(times[slot]))));
    });
  }
  return error;
}

}  // namespace

bool compare_tables() {
  const DifferentialDrive drive;
  const DynamicWindowSettings settings;
  const ConvexPolygon hull = padded(octagon(0.35), settings.padding_m);

  const double begin_us = cpu_us();
  const CellTimes cells = hull_cell_times(drive, hull, settings.cell_m, settings.horizon_s);
  const double built_us = cpu_us();
  const Quantiser uniform = Quantiser::uniform(cells.horizon_s);
  const CollisionTable table(cells, uniform);
  const double stored_us = cpu_us();
  const Quantiser fitted = Quantiser::lloyd_max(cells.times_s, cells.horizon_s);
  fmt::print(
      "Look-up tables: {} x {} cells, {} stored, {} entries; {:.2f} MB. Exact times {:.2f} s, table {:.2f} "
      "s, levels of Lloyd and Max {:.2f} s.\n",
      cells.grid.columns, cells.grid.rows, table.stored_cells(), table.stored_cells() * kGridSide * kGridSide,
      static_cast<double>(table.bytes()) * 1e-6, 1e-6 * (built_us - begin_us), 1e-6 * (stored_us - built_us),
      1e-6 * (cpu_us() - stored_us));
  fmt::print("Stored times compared with the exact minimum over all points of the cell:\n");
  fmt::print("  {:<44}{:>10}{:>10}{:>12}{:>10}{:>10}{:>10}\n", "", "mean ms", "worst ms", "mean of %",
             "% of mean", "bytes", "too late");
  const TableError even = table_error(cells, drive, [&](auto) -> const Quantiser& { return uniform; });
  even.print("uniform, 255 steps", static_cast<double>(table.bytes()) /
                                       static_cast<double>(table.stored_cells() * kGridSide * kGridSide));
  const TableError fit = table_error(cells, drive, [&](auto) -> const Quantiser& { return fitted; });
  fit.print(
      "Lloyd-Max, 256 levels for all cells",
      static_cast<double>(table.bytes()) / static_cast<double>(table.stored_cells() * kGridSide * kGridSide));
  std::size_t wrong = even.too_late + fit.too_late;
  Quantiser own = uniform;
  for (const std::size_t levels : {256, 16, 4}) {
    const TableError each = table_error(cells, drive, [&](std::span<const float> times) -> const Quantiser& {
      return own = Quantiser::lloyd_max(times, cells.horizon_s, levels);
    });
    each.print(fmt::format("Lloyd-Max, {} levels for each cell", levels).c_str(), 1);
    wrong += each.too_late;
  }
  if (wrong > 0) fmt::print("WRONG: {} stored times are later than exact ones\n", wrong);
  if (even.mean_ratio() > 0.015) fmt::print("WRONG: the uniform table's mean error is above 1.5 %\n");
  return wrong == 0 && even.mean_ratio() <= 0.015;
}

}  // namespace sidestep
