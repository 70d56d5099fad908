// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/check_command.hpp"

#include <algorithm>
#include <csignal>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "common/process/exit_code.hpp"
#include "common/process/help/page_path.hpp"
#include "common/process/output_paths.hpp"
#include "common/terminal/terminal.hpp"
#include "deploy/trial/scenario/reachable_goals.hpp"
#include "deploy/trial/scenario/scenario_picture.hpp"
#include "deploy/trial/scenario/scenario_schema.hpp"
#include "deploy/trial/scenario/text_picture.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"

namespace sidestep {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  std::string picture_file;
  bool prints_schema = false;
};

int picture_columns() { return std::min(screen_size(STDOUT_FILENO).columns, 120); }

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// What the file describes, in one line.
std::string summary(const Scenario& scenario) {
  std::string text = fmt::format("{:g} m x {:g} m, {}", scenario.field.length_m, scenario.field.width_m,
                                 counted(scenario.robots.size(), "robot", "robots"));
  if (!scenario.obstacles.empty())
    text += ", " + counted(scenario.obstacles.size(), "static obstacle", "static obstacles");
  if (scenario.map) text += ", map " + scenario.map->name();
  if (!scenario.opponents.empty())
    text += ", " + counted(scenario.opponents.size(), "moving obstacle", "moving obstacles");
  const auto waiting = static_cast<std::size_t>(
      std::ranges::count_if(scenario.robots, [](const RobotSpec& robot) { return robot.goals.empty(); }));
  if (waiting > 0)
    text += fmt::format("; {} without goals, waiting for orders", counted(waiting, "robot", "robots"));
  return text + fmt::format("; margin {:g} m, of which the safety budget needs {:g} m", scenario.margin_m,
                            budget_of(scenario).required_margin_m());
}

/// Checks one file, and prints what it found. Returns whether all goals can be reached.
bool check(const std::string& file, bool draws, const std::string& picture_file) {
  Scenario scenario = load_scenario(file);
  std::string faults;
  if (scenario.has_test_keys) {
    const FaultTest test = load_fault_test(file);
    faults =
        fmt::format("{} and {}: `sidestep test {}` runs it\n", counted(test.faults.size(), "fault", "faults"),
                    counted(test.expectations.size(), "expectation", "expectations"), file);
  }
  if (!picture_file.empty()) require_replaceable(picture_file);
  std::string text = draws ? text_picture(scenario, picture_columns()) : "";
  const auto unreachable = unreachable_goals(scenario);
  const bool is_good = !unreachable || unreachable->empty();
  text += fmt::format("{}: {}, {}\n{}", file, is_good ? "valid" : "valid, but goals cannot be reached",
                      summary(scenario), faults);
  if (scenario.map && !scenario.map->notice().empty()) text += scenario.map->notice() + "\n";
  if (!unreachable)
    text += "whether robots can reach their goals was not examined: the map has too many walls\n";
  for (const std::string& problem : unreachable.value_or(std::vector<std::string>{})) text += problem + "\n";
  const int error = write_text(stdout, text);
  if (!picture_file.empty()) write_file(picture_file, scenario_picture(scenario));
  require_printed(error);
  return is_good;
}

int check_files(const CheckOptions& options) {
  // The picture is drawn even if the reader of the output disappears.
  std::signal(SIGPIPE, SIG_IGN);
  if (options.prints_schema) {
    write_output(scenario_schema());
    return 0;
  }
  const bool is_one = options.files.size() == 1;
  if (!is_one && !options.picture_file.empty()) throw UsageError("--svg: expected one FILE, got several");
  require_separate_outputs({{"FILE", options.files.front()}}, {{"--svg", options.picture_file}});
  bool all_good = true;
  for (const std::string& file : options.files)
    all_good = check(file, is_one, options.picture_file) && all_good;
  return all_good ? 0 : kExitFailure;
}

}  // namespace

void add_check_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<CheckOptions>();
  const CliCommand command = root.add_subcommand(
      "check", "Checks scenario files without running them, and draws the floor if there is one file");
  const Option files = command.add_option("FILE", options->files,
                                          "scenario files, see " + page_path("deploy/scenarios/README.md"));
  const Option svg = command.add_option(
      "--svg", options->picture_file, "draw the scenario to this SVG file, too; an earlier file is replaced");
  const Option schema = command.add_flag("--schema", options->prints_schema,
                                         "print the JSON schema of scenario files instead, for editors");
  schema.excludes(files).excludes(svg);
  command.on_parsed([options, files, schema, &action] {
    if (!files.is_given() && !schema.is_given()) throw UsageError("FILE is required");
    action = [options] { return check_files(*options); };
  });
}

}  // namespace sidestep
