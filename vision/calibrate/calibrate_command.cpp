// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/calibrate_command.hpp"

#include <fmt/format.h>
#include <memory>
#include <stdexcept>

#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "common/process/command_line.hpp"
#include "common/process/help/page_path.hpp"
#include "vision/calibrate/calibrate_colours.hpp"
#include "vision/calibrate/calibrate_geometry.hpp"

namespace sidestep {
namespace {

constexpr const char* kName = "sidestep-vision calibrate";

struct CalibrateOptions {
  CalibrateColoursOptions colours;
  std::string points_file, out_file;
};

void write_out(const std::string& text, const std::string& path) {
  if (path.empty()) return write_output(text);
  write_file(path, text);
}

int run_colours(const CalibrateOptions& options) {
  if (options.colours.scenario_file.empty() || options.colours.frame_files.empty())
    throw std::invalid_argument("expected SCENARIO and at least one FRAME, or --geometry POINTS");
  const LearnedColours learned = calibrate_colours(options.colours);
  for (const LearnedColour& one : learned.colours)
    fmt::print(stderr, "{}: {:<7} {:6} pixels, {:.1f} % recognised\n", kName, named(one.colour).name,
               one.pixels, 100 * one.recall);
  for (const std::string& warning : learned.warnings) fmt::print(stderr, "{}: warning: {}\n", kName, warning);
  if (!is_plausible(learned))
    throw std::runtime_error("no file written: the pictures do not match the scenario");
  write_out(colours_text(learned.thresholds), options.out_file);
  return 0;
}

int run_geometry(const CalibrateOptions& options) {
  std::vector<NumberedCamera> cameras;
  for (const CalibratedCamera& one : calibrate_geometry(load_points(options.points_file))) {
    fmt::print(stderr, "{}: {}\n", kName, describe(one));
    cameras.push_back(one.camera);
  }
  write_out(cameras_text(cameras), options.out_file);
  return 0;
}

int calibrate(const CalibrateOptions& options) {
  if (!options.out_file.empty()) require_replaceable(options.out_file);
  return options.points_file.empty() ? run_colours(options) : run_geometry(options);
}

}  // namespace

void add_calibrate_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<CalibrateOptions>();
  CalibrateColoursOptions& colours = options->colours;
  const CliCommand command = root.add_subcommand("calibrate",
                                                 "Learns colours from pictures of a floor on which "
                                                 "everything is at its start position. With --geometry: "
                                                 "calibrates cameras from points with known positions");
  const Option geometry = command.add_option(
      "--geometry", options->points_file,
      "calibrate cameras instead, from this file of points, see " + page_path("vision/README.md"));
  command
      .add_option("SCENARIO", colours.scenario_file,
                  "scenario file, see " + page_path("deploy/scenarios/README.md"))
      .excludes(geometry);
  command.add_option("FRAME", colours.frame_files, "pictures by cameras, such as PNG files")
      .excludes(geometry);
  command
      .add_option("--camera", colours.cameras,
                  "numbers of the cameras: one for all frames, or one for each frame as N,N,...")
      .comma_separated()
      .show_default()
      .excludes(geometry);
  command.add_option("--cameras", colours.cameras_file, "file of cameras [cameras as in the scenario]")
      .excludes(geometry);
  command.add_option("--layout", colours.layout_file, "layout of the robots' markers [the butterfly]")
      .excludes(geometry);
  command
      .add_option("--format", colours.format,
                  "format of the frames to which the thresholds will apply [the scenario's]")
      .check(one_of({"yuv422", "rgb"}))
      .excludes(geometry);
  command.add_option("--out", options->out_file,
                     "file for the thresholds or cameras; an earlier file is replaced [standard output]");
  command.on_parsed([options, &action] { action = [options] { return calibrate(*options); }; });
}

}  // namespace sidestep
