// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/launcher.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <stdexcept>

#include "common/keys/key_folder.hpp"
#include "common/log/log.hpp"
#include "common/motion/time_to_rest.hpp"
#include "common/process/stop_signals.hpp"
#include "common/protocol/process_names.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/run/launch/end_process.hpp"
#include "deploy/run/launch/fatal_deaths.hpp"
#include "deploy/run/launch/monitor_process.hpp"
#include "deploy/run/launch/process_command.hpp"
#include "deploy/run/launch/process_group.hpp"
#include "deploy/run/launch/process_keys.hpp"
#include "deploy/view/launcher_input.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kPollPeriod = 20ms;      // maximum delay before a death is noticed
constexpr Duration kStartInterval = 100ms;  // simultaneous starts would stall DDS discovery
constexpr Duration kStartupTimeout = 20s;   // maximum time from the last start until all is ready
constexpr Duration kSettlingTime = 500ms;   // time after all arrivals, for the final status messages
constexpr Duration kStuckTimeout = 2s;      // minimum time since the last death
constexpr auto kTerminationTimeout = 3000ms;
constexpr std::size_t kShownLines = 8;

/// Settings of a bus that receives everything, for audit and recording.
DdsSettings with_keep_all(DdsSettings dds) {
  dds.keeps_all = true;
  return dds;
}

}  // namespace

Launcher::Launcher(const RunOptions& options, const Scenario& scenario, const Placement& placement,
                   const NamespaceNetwork* network, Processes& processes, Predecessors before)
    : options_(options),
      scenario_(scenario),
      placement_(placement),
      network_(network),
      children_(processes),
      before_(std::move(before)),
      revoked_keys_(key_folder_of_process(options, "vision", scenario)),
      bus_(with_keep_all(options.dds)),
      rules_(bus_, static_cast<std::uint32_t>(Sender::kOperator), SharedRules(scenario),
             [this](const RulesMismatch& mismatch) {
               metrics_.on_mismatch(mismatch);
               print(describe(mismatch), LogLevel::kWarning);
             }),
      metrics_(scenario),
      auditor_(scenario, {}) {
  metrics_.set_auditor(auditor_);
  bus_.trust_first_senders();  // these are the processes that this launcher starts
  auditor_.on_violation([this](const Violation& violation) {
    if (printed_violations_++ < AuditTotals::kMaxKept)
      print("audit: " + to_line(violation), LogLevel::kError);
  });
  listen(bus_, scenario, auditor_);
  if (!options.recording_file.empty()) {
    recording_.emplace(options.recording_file, recording_header(scenario, options.scenario_file));
    recording_->on_failure([this](const std::string& failure) {
      recording_failure_ = failure;
      print("recording: " + failure, LogLevel::kError);
    });
    record(bus_, scenario, *recording_);
  }
  listen(bus_, metrics_);
}

Report Launcher::run() {
  const StopSignals stop_signals([this] { is_interrupted_ = true; },
                                 [this] {
                                   gives_up_ = true;
                                   bus_.stop();
                                 });
  began_ = bus_.now();
  try {
    work();
  } catch (const std::exception& error) {
    abort_reason_ = error.what();
  }
  try {
    bring_to_rest();
  } catch (const std::exception& error) {
    if (abort_reason_.empty()) abort_reason_ = error.what();
  }
  if (options_.monitor_port) end_monitored_run();
  Report report = metrics_.report();
  report.trace = metrics_.floor_trace();
  for (const std::string& name : children_.terminate(kTerminationTimeout))
    print(name + " did not stop in time and was killed", LogLevel::kWarning);
  report.program = "run";
  report.seed = options_.floor.seed;
  report.abort_reason = abort_reason_;
  report.must_arrive = !metrics_.awaits_orders() || options_.until_idle;
  report.duration_s = to_seconds(bus_.now() - began_ + before_.age);
  report.fast_dds = fast_dds_version();
  if (ready_at_) report.startup_s = to_seconds(*ready_at_ - began_);
  report.processes = children_.resource_use();
  report.director_deaths = before_.deaths;
  report.ending = ending_;
  report.recording_failure = recording_failure_;
  return report;
}

void Launcher::finish_recording(Report& report) {
  if (!recording_) return;
  recording_->add_report(bus_.now(), to_json(report));
  try {
    recording_->close();
  } catch (const std::runtime_error&) {
    // on_failure() has already reported the failure.
  }
  report.recording_failure = recording_failure_;
}

void Launcher::work() {
  print(fmt::format("Fast DDS {}, domain {}", fast_dds_version(), options_.dds.domain));
  if (network_) {
    print(fmt::format(
        "hosts are network namespaces; to observe them, run: ip netns exec {} sidestep topic list "
        "--domain {} --interface {}{}{}",
        network_->bridge(), options_.dds.domain, options_.dds.interface,
        options_.dds.peers.empty() ? "" : " --peers ", fmt::join(options_.dds.peers, ",")));
  }
  // Before all others, so that they do not start if the page cannot be shown.
  if (options_.monitor_port && before_.deaths.empty()) start_monitor();
  if (is_interrupted_) {
    abort_reason_ = kInterrupted;
    return;
  }
  start_core();
  while (!check_end()) {
    start_due_agents();
    send_revoked_keys();
    bus_.run_until(next_poll());
    for (const ChildEvent& event : children_.poll(0ms)) handle(event);
    print_new_epochs();
    if (!options_.is_quiet) display_.update(metrics_, bus_.now());
  }
}

void Launcher::print(const std::string& line, LogLevel level) {
  if (level >= options_.log_level) children_.log(log_line(options_.dds.participant, level, line));
  if (!options_.is_quiet) display_.print(line, level);
}

void Launcher::print_new_epochs() {
  const std::vector<EpochRecord>& epochs = metrics_.epochs();
  for (; printed_epochs_ < epochs.size(); ++printed_epochs_) {
    const EpochRecord& epoch = epochs[printed_epochs_];
    print(fmt::format("{} begins epoch {}: {}", epoch.coordinator, epoch.epoch, epoch.reason),
          LogLevel::kInfo);
  }
}

Time Launcher::next_poll() {
  const Time latest = bus_.now() + kPollPeriod;
  return is_ready_ && director_.next ? std::min(latest, director_.next()) : latest;
}

void Launcher::start(const std::string& name, const std::string& program, bool is_restarted,
                     const std::vector<std::string>& arguments, Duration rest_time) {
  ProcessSpec process{name,
                      program,
                      options_.scenario_file,
                      options_.dds.domain,
                      arguments,
                      is_restarted,
                      options_.dds.peers,
                      key_folder_of_process(options_, name, scenario_),
                      options_.dds.insecure,
                      rest_time};
  if (options_.faults) process.arguments.push_back("--faults");
  process.arguments.push_back("--log-level");
  process.arguments.emplace_back(to_text(options_.log_level));
  start(process, placement_.host_of(name));
  last_start_ = bus_.now();
}

void Launcher::start(const ProcessSpec& process, const HostSpec& host) {
  const pid_t pid = children_.start(child(process, host));
  processes_[process.name] = process;
  print(fmt::format("{} {} as pid {}{}", before_.deaths.empty() ? "started" : "still running:", process.name,
                    pid, options_.hosts_file.empty() ? "" : " on host " + host.name));
}

ChildSpec Launcher::child(const ProcessSpec& process, const HostSpec& host) const {
  return child_spec(process, host, network_ ? network_->full_name(host.target) : host.target);
}

void Launcher::restart(const std::string& process, const std::string& scenario_file) {
  ProcessSpec spec = processes_.at(process);
  spec.scenario_file = scenario_file;
  children_.restart(child(spec, placement_.host_of(process)));
  dead_.erase(process);
}

void Launcher::start_twin(RobotId robot, const std::string& name) {
  ProcessSpec spec = processes_.at(agent_process(robot));
  spec.name = name;
  spec.restart = false;
  start(spec, placement_.host_of(agent_process(robot)));
}

void Launcher::start_monitor() {
  const pid_t pid = children_.start(monitor_child(options_));
  print(fmt::format("started {} as pid {}", kMonitorProcess, pid));
  const auto is_listening = [&] {
    return std::ranges::any_of(children_.last_lines(kMonitorProcess),
                               [](const std::string& line) { return line.starts_with("monitor: http"); });
  };
  for (const Time deadline = bus_.now() + kStartupTimeout; !is_listening();) {
    bus_.run_until(bus_.now() + kPollPeriod);
    if (is_interrupted_) return;
    for (const ChildEvent& event : children_.poll(0ms)) {
      print_last_lines(event.name);
      throw std::runtime_error(fmt::format("the {} ended: {}", event.name, event.reason));
    }
    if (bus_.now() > deadline)
      throw std::runtime_error(
          fmt::format("the monitor does not listen {} s after its start", to_seconds(kStartupTimeout)));
  }
  // Not in the log, because other users may read that, and the address may have the token.
  if (!options_.is_quiet) display_.print("monitor: " + monitor_url(options_));
}

void Launcher::end_monitored_run() {
  if (is_ready_)
    children_.add_input(kMonitorProcess, std::string(LauncherInput::kRunIsOver) + "\n");
  else
    // There is nothing to see. Waits for its end, so that it is not taken for a page that stays.
    end_process(children_, kMonitorProcess, kTerminationTimeout);
}

void Launcher::start_core() {
  const RestartSpec& restart = scenario_.restart;
  const bool is_driven = !options_.floor.driver.empty();
  const FloorProcess robots = robots_process(options_.floor), vision = vision_process(options_.floor);
  start(robots.name, robots.program, is_driven && restart.robots, robots.arguments,
        is_driven ? time_to_rest(scenario_.limits) : 0s);
  start(vision.name, vision.program, restart.vision, vision.arguments);
  if (scenario_.coordinators == 1) return start("coordinator", "sidestep-coordinator", restart.coordinator);
  // All coordinators begin as standbys, so a restarted coordinator does not take over from the active one.
  for (int number = 0; number < scenario_.coordinators; ++number) {
    start(coordinator_process(number), "sidestep-coordinator", restart.coordinator,
          {"--standby", "--number", std::to_string(number)});
  }
}

void Launcher::start_due_agents() {
  if (agents_started_ == scenario_.robots.size() || bus_.now() < last_start_ + kStartInterval) return;
  const RobotId robot = scenario_.robots[agents_started_++].id;
  std::vector<std::string> arguments{"--robot", std::to_string(robot)};
  if (!options_.planner.empty()) arguments.insert(arguments.end(), {"--planner", options_.planner});
  start(agent_process(robot), "sidestep-agent", scenario_.restart.agents, arguments,
        time_to_rest(scenario_.limits));
}

void Launcher::send_revoked_keys() try {
  const auto list = revoked_keys_.changed(bus_.now());
  if (!list) return;
  // Processes on this machine have no input: they read the file themselves.
  for (const auto& [name, process] : processes_)
    children_.add_input(name, file_input(key_files::kRevoked, *list));
} catch (const std::runtime_error& error) {
  print(error.what(), LogLevel::kWarning);
}

void Launcher::handle(const ChildEvent& event) {
  if (event.name == kMonitorProcess) {
    // The run does not need the monitor.
    print(fmt::format("the monitor ended: {}", event.reason), LogLevel::kWarning);
    return print_last_lines(kMonitorProcess);
  }
  if (event.kind == ChildEvent::Kind::kStarted) {
    print(fmt::format("started {} again as pid {}", event.name, event.pid));
    if (recording_) recording_->add_event(bus_.now(), "restart", event.name + " was started again");
    return;
  }
  const Time now = bus_.now();
  metrics_.on_death(event.name, event.reason, now, event.will_restart);
  if (recording_)
    recording_->add_event(now, "death",
                          fmt::format("{} {}: {}", event.name, verb_of_end(event.reason), event.reason));
  print(fmt::format("{} (pid {}) {}: {}{}", event.name, event.pid, verb_of_end(event.reason), event.reason,
                    event.will_restart ? "; it will be restarted" : ""),
        LogLevel::kWarning);
  print_last_lines(event.name);
  if (event.will_restart) return;
  dead_.insert(event.name);
  last_death_ = now;
  if (!is_ready_ && abort_reason_.empty())
    abort_reason_ = fmt::format("{} died during startup: {}", event.name, event.reason);
}

void Launcher::print_last_lines(const std::string& process) {
  const auto lines = children_.last_lines(process);
  for (std::size_t i = lines.size() - std::min(lines.size(), kShownLines); i < lines.size(); ++i) {
    if (!options_.is_quiet) display_.print("  " + lines[i]);
  }
}

bool Launcher::check_end() {
  if (is_interrupted_ && is_ready_ && metrics_.awaits_orders()) return end_on_demand();
  if (is_interrupted_) abort_reason_ = kInterrupted;
  if (!abort_reason_.empty()) return true;
  if (!is_ready_) return check_end_of_startup();
  return director_.act ? director_.act() : check_end_of_drive();
}

bool Launcher::check_end_of_startup() {
  const bool all_started = agents_started_ == scenario_.robots.size();
  // The coordinator grants only after every agent has registered, so the agents' status need not be awaited.
  // Without the simulator there is no ground truth.
  const bool has_robots = options_.floor.driver.empty() ? metrics_.has_truth() : metrics_.has_seen_robots();
  is_ready_ = all_started && has_robots && metrics_.granting_since();
  if (is_ready_) {
    ready_at_ = bus_.now();
    print("all processes are running and the coordinator grants");
  }
  if (is_ready_ || !all_started || bus_.now() < last_start_ + kStartupTimeout) return false;
  abort_reason_ = startup_failure();
  return true;
}

std::string Launcher::startup_failure() const {
  std::vector<std::string> reasons;
  if (options_.floor.driver.empty() && !metrics_.has_truth())
    reasons.push_back("no ground truth from the simulator");
  if (!options_.floor.driver.empty() && !metrics_.has_seen_robots())
    reasons.push_back("vision sees no robot");
  if (const auto silent = metrics_.silent_agents(); !silent.empty())
    reasons.push_back(fmt::format("no status from agent {}", fmt::join(silent, ", ")));
  if (!metrics_.has_coordinator_state())
    reasons.push_back("no state from the coordinator");
  else if (!metrics_.granting_since())
    reasons.push_back(
        fmt::format("no registration of robot {}", fmt::join(metrics_.unregistered_robots(), ", ")));
  return fmt::format("not ready after {} s: {}", to_seconds(kStartupTimeout), fmt::join(reasons, "; "));
}

bool Launcher::check_end_of_drive() {
  const Time now = bus_.now();
  const bool awaits_orders = metrics_.awaits_orders();
  if (!may_end_by_itself() || !metrics_.all_arrived())
    arrived_since_.reset();
  else if (!arrived_since_)
    arrived_since_ = now;
  if (arrived_since_ && now - *arrived_since_ >= kSettlingTime) return true;

  const double limit_s = options_.seconds.value_or(awaits_orders ? std::numeric_limits<double>::infinity()
                                                                 : scenario_.time_limit_s);
  if (to_seconds(now - drive_started_at()) > limit_s) {
    if (awaits_orders) return end_on_demand();
    abort_reason_ = fmt::format("time limit of {} s", limit_s);
  } else if (is_stuck(now)) {
    abort_reason_ = death_text();
  }
  return !abort_reason_.empty();
}

bool Launcher::may_end_by_itself() const {
  return !metrics_.awaits_orders() || (options_.until_idle && metrics_.has_received_orders());
}

bool Launcher::end_on_demand() {
  if (has_fatal_deaths()) abort_reason_ = death_text();
  return true;
}

std::string Launcher::death_text() const { return fmt::format("{} died", fmt::join(dead_, ", ")); }

Time Launcher::drive_started_at() const {
  return before_.deaths.empty() ? *metrics_.granting_since() : began_ - before_.age;
}

bool Launcher::has_fatal_deaths() const {
  return are_fatal(dead_, scenario_.coordinators, metrics_.progress(), !may_end_by_itself());
}

bool Launcher::is_stuck(Time now) const {
  if (dead_.empty() || now - last_death_ < kStuckTimeout) return false;
  const bool is_unseen = now - *metrics_.seen_at() > kStuckTimeout;
  return (is_unseen || metrics_.all_at_rest()) && has_fatal_deaths();
}

}  // namespace sidestep
