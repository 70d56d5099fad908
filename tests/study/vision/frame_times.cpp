// SPDX-License-Identifier: Apache-2.0
#include "tests/study/vision/frame_times.hpp"

#include <algorithm>

#include "tests/study/measurement/cpu_clock.hpp"
#include "tests/study/vision/vision_testbed.hpp"
#include "vision/colours/default_colours.hpp"

namespace sidestep {
namespace {

constexpr Field kDivisionA{12, 9};

}  // namespace

StudyTable frame_times(const FrameTimes& settings, std::uint64_t seed, const ProgressCallback& advance) {
  StudyTable table;
  table.name = "frame-times";
  table.columns = {"cameras", "rounds", "robots_tracked", "median_us", "p99_us"};
  struct Grid {
    int columns, rows;
  };
  const Grid grids[] = {{1, 1}, {2, 1}, {2, 2}};
  PlotLine line{"median, minimum and p99", {}};
  std::size_t done = 0;
  Rng rng(seed);
  for (const auto [columns, rows] : grids) {
    VisionTestbed testbed(testbed_scenario(kDivisionA, columns, rows), {},
                          default_colours(RenderSpec().format), rng);
    std::vector<double> times_us;
    std::size_t tracked = 0;
    for (std::size_t round = 0; round < settings.rounds; ++round) {
      if (round % settings.frames_per_scene == 0) testbed.reset(kRobotsPerTeam);
      testbed.step();
      const double begin_us = cpu_us();
      testbed.run_vision();
      times_us.push_back(cpu_us() - begin_us);
      tracked += testbed.world().robots().size();
      advance(++done, settings.rounds * std::size(grids));
    }
    std::ranges::sort(times_us);
    line.points.push_back({static_cast<double>(columns * rows), times_us[times_us.size() / 2],
                           times_us.front(), times_us[times_us.size() * 99 / 100]});
    table.rows.push_back(
        cells(columns * rows, settings.rounds,
              fmt::format("{:.2f}", static_cast<double>(tracked) / static_cast<double>(settings.rounds)),
              fmt::format("{:.0f}", times_us[times_us.size() / 2]),
              fmt::format("{:.0f}", times_us[times_us.size() * 99 / 100])));
  }
  table.plots = {{.title = "From frames to the world",
                  .x_label = "cameras",
                  .y_label = "processor time (us)",
                  .lines = {line}}};
  return table;
}

}  // namespace sidestep
