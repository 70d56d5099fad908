// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/camera/pattern_command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

#include "common/marking/butterfly.hpp"
#include "common/marking/layout_file.hpp"
#include "deploy/evaluation/camera/pattern_count.hpp"
#include "common/marking/pose_error.hpp"
#include "common/marking/symmetry.hpp"

namespace sidestep {

std::string describe_layout(const MarkingLayout& layout, double dot_sd_m) {
  const std::size_t turns = turns_of(layout).size();
  const std::uint64_t used = used_colours(layout);
  std::string text = fmt::format("{}: {} dots and the centre, ", layout.name, layout.dots.size());
  text += turns == 1 ? "no turn puts the dots on each other\n"
                     : fmt::format("turns by {:g} degrees put the dots on each other\n",
                                   360.0 / static_cast<double>(turns));
  text += fmt::format("patterns: {} of {} that {} colours can show; the most alike differ in {} dot{}\n",
                      layout.patterns.size(), countable_patterns(layout, used), used,
                      smallest_difference(layout), smallest_difference(layout) == 1 ? "" : "s");
  text += "patterns with other numbers of colours:";
  for (std::uint64_t colours = 2; colours <= 6; ++colours)
    text += fmt::format(" {}: {}{}", colours, countable_patterns(layout, colours), colours < 6 ? "," : "\n");
  const PoseError error = predicted_pose_error(layout, dot_sd_m);
  text += fmt::format(
      "with {:g} mm per axis and dot: position {:.3f} mm ahead and {:.3f} mm aside, heading {:.3f} degrees\n",
      dot_sd_m * 1e3, error.ahead_m * 1e3, error.aside_m * 1e3, error.heading_rad * 180 / 3.14159265358979);
  return text;
}

void add_pattern_command(CLI::App& root, std::function<int()>& action) {
  struct Options {
    std::string layout_file;
    double dot_mm = 1;
  };
  CLI::App* command = root.add_subcommand(
      "pattern", "Says how many robots a layout of markings tells apart, and how well it tells their poses");
  const auto options = std::make_shared<Options>();
  command->add_option("LAYOUT", options->layout_file,
                      "layout file, such as deploy/scenarios/markings/square.yaml [the built-in butterfly]");
  command->add_option("--dot-mm", options->dot_mm, "standard deviation of a dot's position per axis")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->callback([&action, options] {
    action = [options] {
      const MarkingLayout layout =
          options->layout_file.empty() ? butterfly() : load_layout(options->layout_file);
      fmt::print("{}", describe_layout(layout, options->dot_mm * 1e-3));
      return 0;
    };
  });
}

}  // namespace sidestep
