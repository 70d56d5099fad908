// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/building/building_command.hpp"

#include <memory>
#include <unistd.h>

#include "common/file/console.hpp"
#include "common/process/command_line.hpp"
#include "common/process/output_paths.hpp"
#include "common/terminal/redrawn_text.hpp"
#include "common/terminal/terminal.hpp"
#include "deploy/trial/simulate/building/building.hpp"

namespace sidestep {
namespace {

/// Shows on stderr what is being done: in a terminal by one line that is redrawn and cleared at the end,
/// elsewhere by one line for each step.
class BuildingProgress {
 public:
  BuildingProgress() = default;
  ~BuildingProgress() {
    if (can_redraw_) print_to(stderr, "{}", kEraseLine);
  }
  BuildingProgress(const BuildingProgress&) = delete;
  BuildingProgress& operator=(const BuildingProgress&) = delete;

  void show(const std::string& step) const {
    print_to(stderr, "{}", can_redraw_ ? redrawn_line(step, STDERR_FILENO) : step + "\n");
  }

 private:
  const bool can_redraw_ = terminal_of(STDERR_FILENO).can_redraw;
};

void build(const BuildingOptions& options) {
  const BuildingProgress progress;
  write_building(options, [&](const std::string& step) { progress.show(step); });
}

}  // namespace

void add_building_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<BuildingOptions>();
  const auto overwrites = std::make_shared<bool>(false);
  const CliCommand command =
      root.add_subcommand("building", "Writes a random building: a map, and a scenario with robots in it");
  command.add_option("FOLDER", options->folder, "receives map.yaml, map.pgm and scenario.yaml").required();
  command.add_option("--kind", options->kind, "rooms and corridors, or halls full of shelves")
      .check(one_of(kBuildingKinds))
      .show_default();
  command.add_option("--seed", options->seed, "the same seed gives the same building")
      .check(non_negative())
      .show_default();
  command.add_option("--cells", options->cells, "cells along each side of the map")
      .check(in_range(100, 4000))
      .show_default();
  command.add_option("--resolution", options->resolution_m, "side of a cell in metres")
      .check(in_range(0.01, 0.2))
      .show_default();
  command.add_option("--robots", options->robots, "number of robots").check(in_range(1, 100)).show_default();
  command.add_option("--goals", options->goals, "goals of each robot").check(in_range(1, 100)).show_default();
  command.add_flag("--force", *overwrites, "overwrite these files if they exist");
  command.on_parsed([&action, options, overwrites] {
    for (const char* file : {"map.yaml", "map.pgm", "scenario.yaml"})
      require_new_output({"FOLDER", options->folder + "/" + file}, *overwrites);
    action = [options] {
      build(*options);
      print_output("{0}/map.yaml, {0}/map.pgm, {0}/scenario.yaml\n", options->folder);
      return 0;
    };
  });
}

}  // namespace sidestep
