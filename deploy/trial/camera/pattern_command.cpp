// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/camera/pattern_command.hpp"

#include <fmt/format.h>
#include <memory>
#include <numbers>

#include "common/file/console.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "common/marking/pose_error.hpp"
#include "common/marking/symmetry.hpp"
#include "common/process/command_line.hpp"
#include "deploy/trial/camera/pattern_count.hpp"

namespace sidestep {

std::string describe_layout(const MarkerLayout& layout, double dot_sd_m) {
  const std::size_t symmetries = rotational_symmetries(layout).size();
  const std::uint64_t used = used_colour_count(layout);
  std::string text = fmt::format("{}: {} dots and the centre, ", layout.name, layout.dots.size());
  text += symmetries == 1
              ? "no rotational symmetry\n"
              : fmt::format("rotational symmetry by {:g} degrees\n", 360.0 / static_cast<double>(symmetries));
  text += fmt::format("patterns: {} of {} possible with {} colours; the most similar differ in {} dot{}\n",
                      layout.patterns.size(), countable_patterns(layout, used), used,
                      min_pattern_distance(layout), min_pattern_distance(layout) == 1 ? "" : "s");
  text += "patterns with other numbers of colours:";
  for (std::uint64_t colours = 2; colours <= 6; ++colours)
    text += fmt::format(" {}: {}{}", colours, countable_patterns(layout, colours), colours < 6 ? "," : "\n");
  const PoseError error = predicted_pose_error(layout, dot_sd_m);
  text += fmt::format(
      "with {:g} mm per axis and dot: position {:.3f} mm longitudinal and {:.3f} mm lateral, heading {:.3f} "
      "degrees\n",
      dot_sd_m * 1e3, error.longitudinal_m * 1e3, error.lateral_m * 1e3,
      error.heading_rad * 180 / std::numbers::pi);
  return text;
}

void add_pattern_command(const CliCommand& root, std::function<int()>& action) {
  struct Options {
    std::string layout_file;
    double dot_mm = 1;
  };
  const CliCommand command = root.add_subcommand(
      "pattern",
      "Evaluates a layout of markers: how many robots it identifies, and how accurate their poses are");
  const auto options = std::make_shared<Options>();
  command.add_option("LAYOUT", options->layout_file,
                     "layout file, such as deploy/scenarios/markings/square.yaml [the built-in butterfly]");
  command.add_option("--dot-mm", options->dot_mm, "standard deviation of a dot's position per axis")
      .check(positive())
      .show_default();
  command.on_parsed([&action, options] {
    action = [options] {
      const MarkerLayout layout =
          options->layout_file.empty() ? butterfly() : load_layout(options->layout_file);
      write_output(describe_layout(layout, options->dot_mm * 1e-3));
      return 0;
    };
  });
}

}  // namespace sidestep
