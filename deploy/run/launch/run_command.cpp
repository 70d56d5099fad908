// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/run_command.hpp"

#include <fmt/format.h>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/config/planner_names.hpp"
#include "common/process/command_line.hpp"
#include "common/process/help/page_path.hpp"
#include "common/process/log_option.hpp"
#include "common/process/process.hpp"
#include "deploy/run/launch/run.hpp"
#include "deploy/run/place/place_floor.hpp"

namespace sidestep {
namespace {

void require_port(const std::string& text) {
  const std::string problem = in_whole_range(1, 65535).problem(text);
  if (!problem.empty()) throw UsageError("--monitor: " + problem);
}

void require_placeable(const FloorOptions& floor) {
  if (floor.driver != "league") throw UsageError("--place requires --driver league");
  try {
    (void)league::parse_unicast_endpoint(*floor.placing_control);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--place: ") + error.what());
  }
}

}  // namespace

void add_run_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<RunOptions>();
  options->dds.participant = "sidestep-run";
  options->dds.identity = {Role::kJudge};
  const CliCommand command =
      root.add_subcommand("run", "Runs a scenario over DDS, with one process for each part of the system");
  command
      .add_option("SCENARIO", options->scenario_file,
                  "scenario file, see " + page_path("deploy/scenarios/README.md"))
      .required();
  command.add_option("--record", options->recording_file,
                     "record all messages to this file; an earlier file is replaced");
  command.add_optional_value("--monitor", options->monitor_port, "8080",
                             "show the run in the browser, on this port of this machine; the page stays when "
                             "the run is over, until Ctrl-C");
  command
      .add_flag("--control", options->has_control,
                "viewers with the printed link may give orders and cause faults")
      .needs(command.option("--monitor"));
  command.add_flag("--close", options->closes_page, "the page ends with the run")
      .needs(command.option("--monitor"));
  command.add_option(
      "--svg", options->picture_file,
      "draw the robots' paths to this SVG file, which plays in a browser; an earlier file is replaced");
  command.add_option("--report", options->report_file,
                     "report file; an earlier file is replaced [reports/<scenario>-<time>.json]");
  command.add_option("--seed", options->floor.seed, "random seed of the simulator's noise")
      .check(non_negative())
      .show_default();
  command.add_option("--seconds", options->seconds, "time limit [the scenario's]").check(positive());
  command.add_flag("--until-idle", options->until_idle,
                   "if clients give the goals: end when all robots have finished their orders, and fail if "
                   "the run ends before");
  command.add_option("--planner", options->planner, "planner of all robots' paths [the scenario's]")
      .check(one_of(driving_planners()));
  command
      .add_option("--domain", options->domain,
                  "DDS domain, 0 .. 232, or 'auto': one that this machine does not use")
      .check([](const std::string& text) {
        return text == "auto" ? "" : in_whole_range(0, kMaxDomain).problem(text);
      })
      .show_default();
  add_dds_options_but_domain(command, options->dds);
  add_log_option(command, options->log_level);
  command.add_flag("--faults", options->faults,
                   "let all processes accept `sidestep fault network`; for tests");
  command.add_option("--simulator", options->floor.simulator,
                     "extra options for sidestep-simulator, e.g. --simulator=\"--ssl-vision\"");
  command.add_option("--vision", options->floor.vision,
                     "extra options for sidestep-vision, e.g. --vision=\"--tracked --colours hall.yaml\"");
  command
      .add_option("--driver", options->floor.driver,
                  "drive real robots, or those of a foreign simulator, with this driver of sidestep-robot; "
                  "Sidestep's simulator does not run")
      .check(one_of(driver_names()))
      .excludes(command.option("--simulator"));
  command
      .add_option("--robots", options->floor.robots,
                  "extra options for sidestep-robot, e.g. --robots=\"--latency-ms 120\"")
      .needs(command.option("--driver"));
  command
      .add_option("--hosts", options->hosts_file,
                  "hosts file, see " + page_path("deploy/run/launch/README.md"))
      .excludes(command.option("--interface"));
  command
      .add_optional_value("--place", options->floor.placing_control, kLeagueControlEndpoint,
                          "with --driver league: first place robots and ball by the control port of the "
                          "simulator, at this ADDRESS:PORT")
      .needs(command.option("--driver"))
      .excludes(command.option("--hosts"));
  command.on_parsed([options, &action] {
    if (options->monitor_port) require_port(*options->monitor_port);
    if (options->floor.placing_control) require_placeable(options->floor);
    action = [options] { return run(*options); };
  });
}

}  // namespace sidestep
