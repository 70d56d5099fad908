// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/conformance_command.hpp"

#include <chrono>
#include <csignal>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <stdexcept>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/file/temporary_folder.hpp"
#include "common/messaging/rules_exchange.hpp"
#include "common/motion/time_to_rest.hpp"
#include "common/process/process.hpp"
#include "common/process/process_identity.hpp"
#include "common/process/stop_signals.hpp"
#include "common/terminal/redrawn_text.hpp"
#include "common/terminal/terminal.hpp"
#include "deploy/audit/audit_totals.hpp"
#include "deploy/run/launch/floor_processes.hpp"
#include "deploy/run/launch/log_notices.hpp"
#include "deploy/run/launch/other_run.hpp"
#include "deploy/run/launch/process_group.hpp"
#include "deploy/trial/conformance/conformance.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr const char* kRunning = "running";
constexpr const char* kSimulator = "simulator";

struct ConformanceOptions {
  std::string scenario_file;
  std::string driver = kRunning;
  FloorOptions floor;
  double silence_m = ConformanceSettings{}.max_silence_m;
  DdsSettings dds;
};

const RobotSpec& only_robot(const Scenario& scenario) {
  if (scenario.robots.size() != 1 || !scenario.obstacles.empty() || scenario.map ||
      !scenario.opponents.empty())
    throw std::invalid_argument(
        fmt::format("{}: expected a scenario with one robot and nothing else on the floor, found {} robots, "
                    "{} obstacles, "
                    "{} opponents{}",
                    scenario.name, scenario.robots.size(), scenario.obstacles.size(),
                    scenario.opponents.size(), scenario.map ? " and a map" : ""));
  return scenario.robots.front();
}

/// Starts the processes that move the robot, and vision, unless they are already running.
class Floor {
 public:
  Floor(const ConformanceOptions& options, const MotionLimits& limits)
      : group_(folder_.file("log")), notices_(folder_.file("log")) {
    if (options.driver == kRunning) return;
    FloorOptions floor = options.floor;
    floor.driver = options.driver == kSimulator ? "" : options.driver;
    floor.memory_folder = folder_.file("memory");
    for (const FloorProcess& process : {robots_process(floor), vision_process(floor)}) {
      std::vector<std::string> argv{
          sibling_program_path(process.program), "--scenario",  options.scenario_file, "--domain",
          std::to_string(options.dds.domain),    "--interface", options.dds.interface};
      if (!options.dds.peers.empty())
        argv.insert(argv.end(), {"--peers", fmt::format("{}", fmt::join(options.dds.peers, ","))});
      // Each process takes its own keys from the folder with the keys of all identities.
      if (!options.dds.keys.empty()) argv.insert(argv.end(), {"--keys", options.dds.keys});
      if (options.dds.insecure) argv.emplace_back("--insecure");
      argv.insert(argv.end(), process.arguments.begin(), process.arguments.end());
      ChildSpec child{process.name, argv};
      // However the examination ends, the robot comes to rest first.
      if (process.program == "sidestep-robot")
        child.rest_time = std::chrono::ceil<std::chrono::milliseconds>(time_to_rest(limits));
      group_.start(child);
    }
    driver_ = robots_process(floor).name;
  }
  ~Floor() {
    if (is_driver_stopped_) stop_driver(false);
    (void)group_.terminate(3000ms);
  }
  Floor(const Floor&) = delete;
  Floor& operator=(const Floor&) = delete;

  /// Stops the process that drives the robot, or lets it go on.
  void stop_driver(bool is_stopped) {
    is_driver_stopped_ = is_stopped;
    (void)group_.send_signal(driver_, is_stopped ? SIGSTOP : SIGCONT);
  }
  /// What the processes have logged since the last call and the user is to know.
  std::vector<std::string> notices() { return notices_.next(); }

  /// Throws std::runtime_error with a process's last lines if that process has ended.
  void check() {
    for (const ChildEvent& event : group_.poll(0ms)) {
      std::string text = fmt::format("{} ended: {}", event.name, event.reason);
      for (const std::string& line : group_.last_lines(event.name)) text += "\n  " + line;
      throw std::runtime_error(text);
    }
  }

 private:
  TemporaryFolder folder_;
  ProcessGroup group_;
  LogNotices notices_;
  std::string driver_;  ///< the name of the process that moves the robot
  bool is_driver_stopped_ = false;
};

/// Whether the robot is moved by a process of ours and seen without it. The template's process is also the
/// camera.
bool can_stop_driver(const std::string& driver) {
  return driver != kRunning && driver != kSimulator && driver != "skeleton";
}

int examine(const ConformanceOptions& options) {
  const Scenario scenario = load_scenario(options.scenario_file);
  const RobotSpec& robot = only_robot(scenario);
  DdsSettings dds = options.dds;
  dds.identity = identity_of_process(robot.id, scenario);
  if (options.driver != kRunning) require_free_domain(dds);  // a run has a simulator and vision of its own
  DdsBus bus(dds);
  bool is_interrupted = false;
  const StopSignals stop_signals([&] {
    is_interrupted = true;
    bus.stop();
  });
  const RulesExchange rules(bus, robot.id, SharedRules(scenario), [](const RulesMismatch& mismatch) {
    fmt::print(stderr, "{}\n", describe(mismatch));
  });
  Floor floor(options, scenario.limits);
  ConformanceSettings settings;
  settings.max_silence_m = options.silence_m;
  if (can_stop_driver(options.driver))
    settings.stop_driver = [&floor](bool is_stopped) { floor.stop_driver(is_stopped); };
  const Conformance conformance(bus, scenario, robot.id, next_incarnation(0, bus.now()), settings);
  const bool has_activity = terminal_of(STDERR_FILENO).can_redraw;
  std::size_t printed = 0;
  std::string activity;
  while (!conformance.is_finished() && !is_interrupted) {
    bus.run_until(bus.now() + 100ms);
    floor.check();
    for (const std::string& notice : floor.notices()) {
      print_to(stderr, "{}{}\n", has_activity ? kEraseLine : "", notice);
      activity.clear();  // is printed again below
    }
    const auto& rows = conformance.report().rows;
    for (; printed < rows.size(); ++printed) {
      if (has_activity) print_to(stderr, "{}", kEraseLine);
      print_output("{}\n", to_line(rows[printed]));
    }
    if (has_activity && conformance.activity() != activity) {
      activity = conformance.activity();
      print_to(stderr, "{}", redrawn_line("... " + activity, STDERR_FILENO));
    }
  }
  if (has_activity) print_to(stderr, "{}", kEraseLine);
  if (is_interrupted) return kExitNotJudged;
  print_output("{}", scenario_lines(conformance.report()));
  if (conformance.report().is_conformant()) return 0;
  return conformance.report().has_failed() ? kExitFailure : kExitNotJudged;
}

}  // namespace

void add_conformance_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<ConformanceOptions>();
  options->dds.participant = "sidestep-conformance";
  const CliCommand command = root.add_subcommand("conformance",
                                                 "Tests whether a robot, alone on a floor, obeys the rules "
                                                 "that others rely on, and measures its capabilities");
  command
      .add_option("SCENARIO", options->scenario_file, "scenario with this robot only, and without obstacles")
      .required();
  std::vector<std::string> drivers = driver_names();
  drivers.insert(drivers.begin(), {kRunning, kSimulator});
  command
      .add_option(
          "--driver", options->driver,
          "running: use a running robot and sidestep-vision, without an agent; simulator: start Sidestep's "
          "simulator; others: start sidestep-robot with this driver")
      .check(one_of(drivers))
      .show_default();
  command.add_option("--robots", options->floor.robots,
                     "extra options for sidestep-robot, e.g. --robots=\"--latency-ms 120\"");
  command.add_option("--vision", options->floor.vision, "extra options for sidestep-vision");
  command.add_option("--simulator", options->floor.simulator, "extra options for sidestep-simulator");
  command
      .add_option("--silence-m", options->silence_m,
                  "how far beyond the stop of its version the robot may come to rest if commands end at full "
                  "speed, as when sidestep-robot is killed")
      .check(in_range(0, 10))
      .show_default();
  add_dds_options(command, options->dds);
  command.on_parsed([options, &action] { action = [options] { return examine(*options); }; });
}

}  // namespace sidestep
