// SPDX-License-Identifier: Apache-2.0
#include "tests/study/camera/camera_study.hpp"

#include <algorithm>
#include <string>

#include "tests/study/camera/camera_picture.hpp"
#include "tests/study/camera/first_view.hpp"
#include "tests/study/camera/guided_drive.hpp"

namespace sidestep {
namespace {

struct CameraSizes {
  int drives = 25;  ///< number of drives for each event and planner
  int views = 100, searches = 50;
};
constexpr CameraSizes kQuick{1, 4, 10};

constexpr std::array<PixelPlanner, 2> kDriving{PixelPlanner::kCells, PixelPlanner::kDiamonds};
constexpr std::array<const char*, kPixelPlanners> kPlannerNames{"cells", "diamonds", "discs"};

/// The summed results of the drives in one row of the table.
struct DriveSum {
  int drives = 0, arrived = 0, contacts = 0, replans = 0, without_cause = 0, false_alarms = 0;
  int noticed = 0, max_frames = 0;
  double max_blind_m = 0;

  void add(const DriveResult& drive) {
    ++drives;
    arrived += drive.arrived ? 1 : 0;
    contacts += drive.contacts;
    replans += drive.replans;
    without_cause += drive.unnecessary_replans;
    false_alarms += drive.false_alarms;
    noticed += drive.noticed_after_frames ? 1 : 0;
    max_frames = std::max(max_frames, drive.noticed_after_frames.value_or(0));
    max_blind_m = std::max(max_blind_m, drive.blind_m);
  }
};

struct Lengths {
  Distribution cells, discs;  ///< lengths relative to the path around the diamonds
  int none = 0;               ///< number of drives in which at least one planner found no path
};

void add(const StageTimes& from, StageTimes& to) {
  for (Distribution StageTimes::*stage :
       {&StageTimes::registration, &StageTimes::segmentation, &StageTimes::blobs, &StageTimes::cells,
        &StageTimes::astar, &StageTimes::diamonds, &StageTimes::discs})
    (to.*stage).add(from.*stage);
}

void add(const DriveResult& drive, Lengths& lengths) {
  if (drive.cells_px == 0 || drive.diamonds_px == 0 || drive.discs_px == 0) {
    ++lengths.none;
    return;
  }
  lengths.cells.add(drive.cells_px / drive.diamonds_px);
  lengths.discs.add(drive.discs_px / drive.diamonds_px);
}

struct Drives {
  StudyTable table;
  StageTimes times;
  Lengths lengths;
  bool is_good = true;
};

Drives all_drives(const CameraSizes& sizes, std::uint64_t seed) {
  Drives result;
  result.table.name = "drives";
  result.table.columns = {"event",         "planner",      "drives",  "arrived",    "contacts",   "replans",
                          "without_cause", "false_alarms", "noticed", "max_frames", "max_blind_m"};
  StudyProgress progress("drives");
  const std::size_t of = kDriveEventNames.size() * kDriving.size() * static_cast<std::size_t>(sizes.drives);
  std::size_t done = 0;
  for (std::size_t event = 0; event < kDriveEventNames.size(); ++event) {
    for (const PixelPlanner planner : kDriving) {
      DriveSum sum;
      for (int i = 0; i < sizes.drives; ++i) {
        const DriveResult one =
            drive(static_cast<DriveEvent>(event), planner, seed + static_cast<std::uint64_t>(i));
        sum.add(one);
        add(one.times, result.times);
        add(one, result.lengths);
        progress(++done, of);
      }
      const bool is_bumped = static_cast<DriveEvent>(event) == DriveEvent::kCameraBumped;
      result.is_good = result.is_good && sum.contacts == 0 && sum.false_alarms == 0 &&
                       sum.noticed == (is_bumped ? sum.drives : 0);
      result.table.rows.push_back(
          cells(kDriveEventNames[event], kPlannerNames[static_cast<std::size_t>(planner)], sum.drives,
                sum.arrived, sum.contacts, sum.replans, sum.without_cause, sum.false_alarms, sum.noticed,
                sum.max_frames, fmt::format("{:.3f}", sum.max_blind_m)));
    }
  }
  return result;
}

StudyTable stage_table(const StageTimes& times) {
  StudyTable table{"stages", {"stage", "count", "median_us", "p99_us"}, {}, {}};
  const auto add_row = [&](const char* name, const Distribution& distribution) {
    table.rows.push_back(cells(name, distribution.size(), fmt::format("{:.0f}", distribution.median()),
                               fmt::format("{:.0f}", distribution.quantile(0.99))));
  };
  add_row("registration of the field's lines", times.registration);
  add_row("segmentation", times.segmentation);
  add_row("blobs and polygons", times.blobs);
  add_row("occupancy grid", times.cells);
  add_row("A* on cells", times.astar);
  add_row("visibility graph, diamonds", times.diamonds);
  add_row("visibility graph, discs", times.discs);
  return table;
}

StudyTable length_table(const Lengths& lengths) {
  StudyTable table{"lengths", {"path", "drives", "no_path", "median", "p99"}, {}, {}};
  const auto add_row = [&](const char* name, const Distribution& ratio) {
    table.rows.push_back(cells(name, ratio.size(), lengths.none, fmt::format("{:.3f}", ratio.median()),
                               fmt::format("{:.3f}", ratio.quantile(0.99))));
  };
  add_row("cells / diamonds", lengths.cells);
  add_row("discs / diamonds", lengths.discs);
  return table;
}

/// A* between random free cells of images, with every heuristic.
StudyTable heuristic_table(const CameraSizes& sizes, std::uint64_t seed) {
  constexpr std::array kHeuristics{CellHeuristic::kNone, CellHeuristic::kStraight, CellHeuristic::kOctile,
                                   CellHeuristic::kManhattan};
  constexpr std::array<const char*, 4> kNames{"none", "straight", "octile", "Manhattan"};
  std::array<Distribution, 4> expanded, excess;
  std::array<int, 4> longer{};
  StudyProgress progress("heuristics");
  for (int view = 0; view < sizes.views; ++view) {
    FirstView first(seed + static_cast<std::uint64_t>(view));
    const BitGrid& blocked = first.guide().cells().blocked;
    const auto free_cell = [&] {
      while (true) {
        const auto column =
            static_cast<int>(first.rng().below(static_cast<std::uint64_t>(blocked.columns())));
        const auto row = static_cast<int>(first.rng().below(static_cast<std::uint64_t>(blocked.rows())));
        if (!blocked.get(column, row)) return Cell{column, row};
      }
    };
    for (int i = 0; i < sizes.searches; ++i) {
      const Cell start = free_cell(), goal = free_cell();
      double shortest = 0;
      for (std::size_t k = 0; k < kHeuristics.size(); ++k) {
        CellAstar astar(kHeuristics[k]);
        const CellRoute& route = astar.search(blocked, start, goal);
        if (k == 0) shortest = route.length_cells;
        if (shortest == 0) break;  // There is no path, or the start is the goal.
        expanded[k].add(static_cast<double>(route.expanded));
        excess[k].add(100 * (route.length_cells / shortest - 1));
        longer[k] += route.length_cells > shortest + 1e-6 ? 1 : 0;
      }
    }
    progress(static_cast<std::size_t>(view) + 1, static_cast<std::size_t>(sizes.views));
  }
  StudyTable table{
      "heuristics", {"heuristic", "searches", "longer", "max_excess_percent", "median_expanded"}, {}, {}};
  for (std::size_t k = 0; k < kHeuristics.size(); ++k)
    table.rows.push_back(cells(kNames[k], excess[k].size(), longer[k],
                               fmt::format("{:.2f}", std::max(0.0, excess[k].quantile(1))),
                               fmt::format("{:.0f}", expanded[k].median())));
  return table;
}

}  // namespace

int study_camera(const StudyOptions& options) {
  require_study_output(options);
  const CameraSizes sizes = options.is_quick ? kQuick : CameraSizes{};
  const auto write = [&](const StudyTable& table) {
    write_study_table(table, "camera", options);
    fmt::print("{}\n", markdown_of(table));
  };
  const Drives drives = all_drives(sizes, options.seed);
  write(drives.table);
  write(stage_table(drives.times));
  write(length_table(drives.lengths));
  write(heuristic_table(sizes, options.seed));
  write_camera_picture(options.seed, options.folder + "/camera.png");
  return drives.is_good ? 0 : 1;
}

}  // namespace sidestep
