// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/potential_study.hpp"

#include <filesystem>
#include <vector>

#include "common/file/write_file.hpp"
#include "tests/study/measurement/cpu_clock.hpp"
#include "tests/study/measurement/distribution.hpp"
#include "tests/study/potential/field_method.hpp"
#include "tests/study/potential/field_picture.hpp"
#include "tests/study/potential/field_scene.hpp"

namespace sidestep {
namespace {

struct PotentialSizes {
  int trials = 200, corridor_trials = 50;
  std::vector<double> spares_m{0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1};
};
PotentialSizes quick_potential_sizes() { return {4, 2, {0.2, 0.6}}; }

std::vector<FieldMethod> methods() {
  using Kind = FieldMethod::Kind;
  return {{Kind::kPotential, 0}, {Kind::kPotential, 0.5}, {Kind::kPotential, 1},
          {Kind::kPotential, 2}, {Kind::kNf1, 0},         {Kind::kEStar, 0}};
}

/// The drives of one method in one kind of scene.
struct Drives {
  int count = 0, ends[4] = {};
  Distribution seconds, reversals_pm, compute_us;  // seconds: only of drives that arrive

  void add(const FieldMethod& method, const PlanWorld& world) {
    const ObstacleWorld obstacles(world.obstacles);
    const double begin_us = cpu_us();
    const FieldDrive drive = drive_by_direction(direction_of(method, world, obstacles), world, obstacles);
    compute_us.add(cpu_us() - begin_us);
    ++count;
    ++ends[static_cast<int>(drive.end)];
    if (drive.end == DriveEnd::kArrived) seconds.add(drive.seconds);
    reversals_pm.add(drive.reversals / std::max(drive.length_m, world.radius_m));
  }
  double percent(DriveEnd end) const { return 100.0 * ends[static_cast<int>(end)] / count; }

  std::vector<std::string> cells() const {
    const bool arrives = seconds.size() > 0;
    return {fmt::format("{}", count),
            fmt::format("{:.1f}", percent(DriveEnd::kArrived)),
            fmt::format("{:.1f}", percent(DriveEnd::kLocalMinimum)),
            fmt::format("{:.1f}", percent(DriveEnd::kContact)),
            fmt::format("{:.1f}", percent(DriveEnd::kTimeLimit)),
            arrives ? fmt::format("{:.2f}", seconds.median()) : "-",
            fmt::format("{:.2f}", reversals_pm.median()),
            fmt::format("{:.2f}", reversals_pm.quantile(0.9)),
            fmt::format("{:.0f}", compute_us.median())};
  }
};

StudyTable empty_table(std::string name, std::vector<std::string> key, const std::string& x_label) {
  StudyTable table;
  table.name = std::move(name);
  table.columns = std::move(key);
  for (const char* column :
       {"scenes", "arrived_percent", "minimum_percent", "contact_percent", "timeout_percent", "seconds",
        "reversals_per_m", "reversals_per_m_p90", "compute_us"})
    table.columns.emplace_back(column);
  table.plots = {{"drives that arrive", x_label, "drives [%]"},
                 {"time to the goal", x_label, "time [s]"},
                 {"oscillation", x_label, "heading reversals per metre"}};
  for (Plot& plot : table.plots)
    for (const FieldMethod& method : methods()) plot.lines.push_back({name_of(method), {}});
  return table;
}

/// Adds the row and the points of one method at one position of the x axis.
void add_drives(StudyTable& table, std::size_t method, double x, std::vector<std::string> key,
                const Drives& drives) {
  for (std::string& cell : drives.cells()) key.push_back(std::move(cell));
  table.rows.push_back(std::move(key));
  table.plots[0].lines[method].points.push_back(plot_point(x, drives.percent(DriveEnd::kArrived)));
  if (drives.seconds.size() > 0)
    table.plots[1].lines[method].points.push_back(plot_point(x, drives.seconds.median()));
  table.plots[2].lines[method].points.push_back(plot_point(x, drives.reversals_pm.median()));
}

StudyTable study_minima(std::uint64_t seed, int trials, const ProgressCallback& progress) {
  StudyTable table = empty_table("minima", {"scene", "method"}, "1 U, 2 wall, 3 corridor, 4 gap, 5 discs");
  std::size_t done = 0;
  for (const FieldScene scene : kFieldScenes) {
    const std::vector<FieldMethod> all = methods();
    for (std::size_t i = 0; i < all.size(); ++i) {
      Drives drives;
      for (int trial = 0; trial < trials; ++trial)
        drives.add(all[i], field_scene(scene, seed + static_cast<std::uint64_t>(trial)));
      add_drives(table, i, static_cast<double>(scene) + 1, {name_of(scene), name_of(all[i])}, drives);
      progress(++done, kFieldScenes.size() * all.size());
    }
  }
  return table;
}

StudyTable study_oscillation(std::uint64_t seed, const PotentialSizes& sizes,
                             const ProgressCallback& progress) {
  StudyTable table =
      empty_table("oscillation", {"spare_m", "method"}, "corridor's width beyond the robot's [m]");
  std::size_t done = 0;
  for (const double spare_m : sizes.spares_m) {
    const std::vector<FieldMethod> all = methods();
    for (std::size_t i = 0; i < all.size(); ++i) {
      Drives drives;
      for (int trial = 0; trial < sizes.corridor_trials; ++trial)
        drives.add(all[i], corridor_scene(spare_m, seed + static_cast<std::uint64_t>(trial)));
      add_drives(table, i, spare_m, {fmt::format("{}", spare_m), name_of(all[i])}, drives);
      progress(++done, sizes.spares_m.size() * all.size());
    }
  }
  return table;
}

/// The picture of a U in which the plain field is trapped, with the paths of all methods.
std::string picture_of_a_trap(std::uint64_t seed) {
  using Kind = FieldMethod::Kind;
  const PlanWorld world = field_scene(FieldScene::kU, seed);
  const ObstacleWorld obstacles(world.obstacles);
  const auto path = [&](const FieldMethod& method, const char* colour) {
    return PicturePath{drive_by_direction(direction_of(method, world, obstacles), world, obstacles).path_m,
                       colour, name_of(method)};
  };
  return field_picture(world, direction_of({Kind::kPotential, 0}, world, obstacles),
                       {path({Kind::kPotential, 0}, "#cf222e"), path({Kind::kPotential, 1}, "#bf8700"),
                        path({Kind::kNf1, 0}, "#8250df"), path({Kind::kEStar, 0}, "#1a7f37")});
}

}  // namespace

int study_potential(const StudyOptions& options) {
  require_study_output(options);
  const PotentialSizes sizes = options.is_quick ? quick_potential_sizes() : PotentialSizes{};
  const StudyTable tables[] = {study_minima(options.seed, sizes.trials, StudyProgress("minima")),
                               study_oscillation(options.seed, sizes, StudyProgress("oscillation"))};
  for (const StudyTable& table : tables) {
    fmt::print("{}", markdown_of(table));
    write_study_table(table, "potential", options);
  }
  const std::string picture = (std::filesystem::path(options.folder) / "trap.svg").string();
  write_file(picture, picture_of_a_trap(options.seed));
  fmt::print("{}\n", picture);
  return 0;
}

}  // namespace sidestep
