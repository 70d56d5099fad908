// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/run.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <unistd.h>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/file/new_file.hpp"
#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "common/messaging/dds/free_domain.hpp"
#include "common/motion/time_to_rest.hpp"
#include "common/process/output_paths.hpp"
#include "common/process/process.hpp"
#include "common/terminal/terminal.hpp"
#include "deploy/audit/metrics/progress.hpp"
#include "deploy/audit/picture/run_picture.hpp"
#include "deploy/run/launch/hosts/run_hosts.hpp"
#include "deploy/run/launch/launcher.hpp"
#include "deploy/run/launch/monitor_process.hpp"
#include "deploy/run/launch/other_run.hpp"
#include "deploy/run/launch/process_keeper.hpp"
#include "deploy/run/launch/process_keys.hpp"
#include "deploy/run/launch/separate_process.hpp"
#include "deploy/view/server/access.hpp"

namespace sidestep {

namespace {

/// When the file was written; nullopt if there is no file.
std::optional<std::filesystem::file_time_type> written_at(const std::string& file) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(file, error);
  return error ? std::nullopt : std::optional(time);
}

void print_verdict(const Report& report) {
  const std::string text = summary(report);
  const bool has_colours = terminal_of(STDOUT_FILENO).has_colours;
  print_to(stdout, "\n{}: {}", report.scenario,
           has_colours ? with_coloured_verdict(text, report.verdict()) : text);
}

/// Throws std::runtime_error if a file cannot be written, before robots start in vain.
void require_outputs(const RunOptions& options, const std::string& report_path, const std::string& log_path) {
  require_replaceable(report_path);
  require_openable(log_path);
  if (!options.recording_file.empty()) require_openable(options.recording_file);
  if (!options.picture_file.empty()) require_replaceable(options.picture_file);
}

/// Prints an error and returns its exit code if another run uses the domain; otherwise returns 0. Listens in
/// a process of its own, because the process that keeps the others must not use the network.
int check_domain(const DdsSettings& dds) {
  return run_separately([&dds] {
    return run_and_report_errors("sidestep run", [&dds] {
      require_free_domain(dds);
      return 0;
    });
  });
}

/// Places the robots in a process of its own, for the same reason. Returns 0, or prints an error and returns
/// its exit code.
int place_robots(const Scenario& scenario, const FloorOptions& floor) {
  return run_separately([&] {
    return run_and_report_errors("sidestep run",
                                 [&] { return place_floor(scenario, place_options_of(floor)); });
  });
}

}  // namespace

int run(const RunOptions& given) {
  // If the reader of the output disappears, the run still continues to its end and its report.
  std::signal(SIGPIPE, SIG_IGN);
  RunOptions options = given;
  std::optional<FreeDomain> free_domain;
  options.dds.domain = given.domain == "auto" ? free_domain.emplace().number() : std::stoi(given.domain);
  const Scenario scenario = load_scenario(options.scenario_file);
  print_to(stderr, "{}\n", budget_line(budget_of(scenario), scenario.margin_m));
  if (scenario.map && !scenario.map->notice().empty()) print_to(stderr, "{}\n", scenario.map->notice());
  if (scenario.has_test_keys)
    print_to(stderr, "faults and expectations in {} apply to `sidestep test` only\n", options.scenario_file);
  const RunHosts hosts(
      options.hosts_file.empty() ? local_hosts(options.dds.interface) : load_hosts(options.hosts_file),
      scenario, !options.floor.driver.empty());
  options.dds.interface = hosts.hosts().interface;
  if (!hosts.hosts().peers.empty()) options.dds.peers = hosts.hosts().peers;
  if (options.monitor_port && hosts.network())
    throw std::invalid_argument(
        "--monitor: a browser cannot reach the monitor in a network namespace; start `sidestep monitor` "
        "there");
  std::string report_path =
      options.report_file.empty() ? default_report_path(scenario.name, std::nullopt) : options.report_file;
  std::string log_path = std::filesystem::path(report_path).replace_extension(".log").string();
  require_separate_outputs({{"SCENARIO", options.scenario_file}, {"--hosts", options.hosts_file}},
                           {{"the log", log_path},
                            {"--report", report_path},
                            {"--record", options.recording_file},
                            {"--svg", options.picture_file}});
  require_keys(options, scenario);
  require_outputs(options, report_path, log_path);
  if (options.monitor_port) {
    if (options.has_control) options.monitor_token = random_token();
    (void)monitor_child(options);
    require_free_port(*options.monitor_port);
  }
  if (const int exit_code = check_domain(options.dds); exit_code != 0) return exit_code;
  if (options.floor.placing_control) {
    if (const int exit_code = place_robots(scenario, options.floor); exit_code != 0) return exit_code;
  }
  if (options.report_file.empty()) {
    // Another run of the scenario may start in the same second.
    log_path = create_new_file(log_path);
    report_path = std::filesystem::path(log_path).replace_extension(".json").string();
  }
  const TemporaryFolder robot_memory;  // starts empty with each run
  options.floor.memory_folder = robot_memory.path();
  ProcessGroup group(log_path);
  const auto finish = [&](const Report& report) {
    const std::string problem = try_write_report(report, report_path);
    print_to(stdout, "{}log: {}\n", problem.empty() ? "report: " + report_path + "\n" : "", log_path);
    std::string drawing;
    if (!options.picture_file.empty())
      drawing = try_write_file(options.picture_file, run_picture_from(to_json(report)));
    require_written({problem, drawing});
    return exit_code(report.verdict());
  };
  const auto began = std::chrono::steady_clock::now();
  const auto former_report = written_at(report_path);
  DirectorWork work;
  // Robots come to rest first; see Ending.
  work.shutdown_timeout += std::chrono::ceil<std::chrono::milliseconds>(2 * time_to_rest(scenario.limits));
  work.run = [&](Processes& processes, const std::vector<std::string>& deaths) {
    return run_and_report_errors("sidestep run", [&] {
      if (!deaths.empty() && !options.recording_file.empty())
        options.recording_file = numbered_path(options.recording_file, deaths.size() + 1);
      const Predecessors before{deaths, std::chrono::steady_clock::now() - began};
      Launcher launcher(options, scenario, hosts.placement(), hosts.network(), processes, before);
      Report report = launcher.run();
      // Before anything is written, because that may fail.
      print_verdict(report);
      const bool had_failed = !report.recording_failure.empty();
      launcher.finish_recording(report);
      if (!had_failed && !report.recording_failure.empty())
        print_to(stdout, "failed: {}\n", report.failure_reason());
      return finish(report);
    });
  };
  work.on_director_lost = [&](const std::string& reason) {
    if (const auto report = written_at(report_path); report && report != former_report) {
      print_to(stdout,
               "\n{}: the process that directed the run died after its report: {}\nreport: {}\nlog: {}\n",
               scenario.name, reason, report_path, log_path);
      return;
    }
    Report report;
    report.program = "run";
    report.scenario = scenario.name;
    report.robots = static_cast<int>(scenario.robots.size());
    report.abort_reason = "the process that directs the run died: " + reason;
    print_verdict(report);
    (void)finish(report);
  };
  work.on_outlasting = [&] {
    print_to(stdout, "the monitor shows the run until Ctrl-C: {}\n", monitor_url(options));
  };
  return keep_processes(group, work);
}

}  // namespace sidestep
