// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/run.hpp"

#include <atomic>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <set>
#include <sstream>

#include "common/config/scenario_loader.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/launch/hosts/namespaces.hpp"
#include "deploy/launch/hosts/placement.hpp"
#include "deploy/launch/hosts/process_command.hpp"
#include "deploy/monitor/metrics/run_metrics.hpp"
#include "deploy/launch/process_group.hpp"
#include "deploy/monitor/metrics/progress.hpp"
#include "deploy/monitor/record/recording.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kStep = 20ms;          // how late a death is noticed
constexpr Duration kStagger = 100ms;      // between starts: discovery of all at once stalls
constexpr Duration kStartDeadline = 20s;  // after the last start
constexpr Duration kSettle = 500ms;       // all have arrived, and the last statuses come in
constexpr Duration kStuck = 2s;           // from a death on, until a run without motion is given up
constexpr auto kPatience = 3000ms;        // for processes to end by themselves
constexpr std::size_t kShownLines = 8;

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

class Launcher {
 public:
  /// `network` is null unless the launcher has made the hosts' namespaces.
  Launcher(const RunOptions& options, const Scenario& scenario, const Placement& placement,
           const NamespaceNetwork* network, const std::string& log_path)
      : options_(options),
        scenario_(scenario),
        placement_(placement),
        network_(network),
        group_(log_path),
        bus_(options.dds),
        judge_(scenario),
        auditor_(scenario, {}) {
    judge_.include(auditor_);
    auditor_.on_violation([this](const Violation& violation) {
      if (said_violations_++ < AuditTotals::kMostKept) say("audit: " + to_line(violation));
    });
    listen(bus_, scenario, auditor_);
    if (!options.recording_file.empty()) {
      recording_.emplace(options.recording_file, recording_head(scenario.name, options.scenario_file));
      record(bus_, scenario, *recording_);
    }
    bus_.subscribe<msg::GroundTruth>(topics::kTruth, [this](const auto& truth) { judge_.on_truth(truth); });
    bus_.subscribe<msg::AgentStatus>(topics::kStatus,
                                     [this](const auto& status) { judge_.on_status(status); });
    bus_.subscribe<msg::CoordinatorState>(topics::kCoordinator,
                                          [this](const auto& state) { judge_.on_coordinator(state); });
  }

  Report run() {
    const StopSignals stop_signals([this] {
      is_interrupted_ = true;
      bus_.stop();
    });
    const Time begin = bus_.now();
    if (network_) {
      say(
          fmt::format("the hosts are network namespaces; to look on: ip netns exec {} sidestep topic list "
                      "--domain {} --interface {}",
                      network_->hub(), options_.dds.domain, options_.dds.interface));
    }
    start_core();
    while (!is_over()) {
      start_due_agents();
      bus_.run_until(bus_.now() + kStep);
      for (const ChildEvent& event : group_.poll(0ms)) handle(event);
      display_.update(judge_, bus_.now());
    }
    if (recording_) recording_->close();
    Report report = judge_.report();
    for (const std::string& name : group_.terminate(kPatience)) say(name + " did not end and was killed");
    report.program = "run";
    report.seed = options_.seed;
    report.failure = failure_;
    report.duration_s = to_seconds(bus_.now() - begin);
    return report;
  }

 private:
  void say(const std::string& line) {
    group_.log(line);
    display_.say(line);
  }

  void start(const std::string& name, const std::string& program, bool restart,
             const std::vector<std::string>& more = {}) {
    const HostSpec& host = placement_.host_of(name);
    ProcessCall call{name, program, options_.scenario_file, options_.dds.domain, more, restart};
    if (options_.faults) call.more.push_back("--faults");
    const pid_t pid =
        group_.start(child_on_host(call, host, network_ ? network_->name_of(host.target) : host.target));
    say(fmt::format("started {} as pid {}{}", name, pid,
                    options_.hosts_file.empty() ? "" : " on host " + host.name));
    last_start_ = bus_.now();
  }

  void start_core() {
    const RestartSpec& restart = scenario_.restart;
    std::vector<std::string> simulator = words_of(options_.simulator);
    simulator.insert(simulator.begin(), {"--seed", std::to_string(options_.seed)});
    start("simulator", "sidestep-simulator", false, simulator);
    start("vision", "sidestep-vision", restart.vision, words_of(options_.vision));
    if (scenario_.coordinators == 1) return start("coordinator", "sidestep-coordinator", restart.coordinator);
    // All begin as standbys, so one that is started again does not take the floor from the one that works.
    for (int number = 0; number < scenario_.coordinators; ++number) {
      start(coordinator_process(number), "sidestep-coordinator", restart.coordinator,
            {"--standby", "--number", std::to_string(number)});
    }
  }

  void start_due_agents() {
    if (agents_started_ == scenario_.robots.size() || bus_.now() < last_start_ + kStagger) return;
    const RobotId robot = scenario_.robots[agents_started_++].id;
    start(agent_process(robot), "sidestep-agent", scenario_.restart.agents,
          {"--robot", std::to_string(robot)});
  }

  void handle(const ChildEvent& event) {
    if (event.kind == ChildEvent::Kind::kStarted) {
      say(fmt::format("started {} again as pid {}", event.name, event.pid));
      return;
    }
    const Time now = bus_.now();
    judge_.on_death(event.name, event.reason, now, event.will_restart);
    say(fmt::format("{} (pid {}) died: {}{}", event.name, event.pid, event.reason,
                    event.will_restart ? ", will be restarted" : ""));
    const auto lines = group_.last_lines(event.name);
    for (std::size_t i = lines.size() - std::min(lines.size(), kShownLines); i < lines.size(); ++i) {
      display_.say("  " + lines[i]);
    }
    if (event.will_restart) return;
    gone_.insert(event.name);
    last_death_ = now;
    if (!is_ready_) failure_ = fmt::format("{} died while starting: {}", event.name, event.reason);
  }

  bool is_over() {
    if (is_interrupted_) failure_ = "interrupted";
    if (!failure_.empty()) return true;
    return is_ready_ ? is_drive_over() : is_start_over();
  }

  bool is_start_over() {
    const bool all_started = agents_started_ == scenario_.robots.size();
    const auto silent = judge_.silent_agents();
    // It grants only once every agent has registered, so nobody has to wait for their statuses too.
    is_ready_ = all_started && judge_.truth_seen() && judge_.granting_since();
    if (is_ready_) say("all processes are up, the coordinator grants");
    if (is_ready_ || !all_started || bus_.now() < last_start_ + kStartDeadline) return false;
    failure_ = fmt::format("not ready after {} s:", to_seconds(kStartDeadline));
    if (!judge_.truth_seen()) failure_ += " no ground truth from the simulator;";
    if (!silent.empty()) failure_ += fmt::format(" no status from agent {};", fmt::join(silent, ", "));
    if (!judge_.coordinator_seen())
      failure_ += " no state from the coordinator;";
    else if (!judge_.granting_since()) {
      failure_ += fmt::format(" not registered: robot {};", fmt::join(judge_.unregistered(), ", "));
    }
    failure_.pop_back();
    return true;
  }

  bool is_drive_over() {
    const Time now = bus_.now();
    if (!judge_.all_arrived())
      arrived_since_.reset();
    else if (!arrived_since_)
      arrived_since_ = now;
    if (arrived_since_ && now - *arrived_since_ >= kSettle) return true;

    const double limit_s = options_.seconds.value_or(scenario_.time_limit_s);
    if (now - *judge_.granting_since() > from_seconds(limit_s)) {
      failure_ = fmt::format("time limit of {} s", limit_s);
    } else if (is_stuck(now)) {
      failure_ = fmt::format("{} died", fmt::join(gone_, ", "));
    }
    return !failure_.empty();
  }

  /// Whether what died for good keeps the rest from arriving, and nothing moves any more.
  bool is_stuck(Time now) const {
    if (gone_.empty() || now - last_death_ < kStuck) return false;
    const bool is_blind = now - *judge_.truth_at() > kStuck;
    if (!is_blind && !judge_.all_at_rest()) return false;
    if (gone_.count("simulator") || gone_.count("vision") || are_coordinators_gone()) return true;
    for (const RobotProgress& row : judge_.progress()) {
      if (!row.arrived && !gone_.count(agent_process(row.robot))) return false;
    }
    return true;
  }

  bool are_coordinators_gone() const {
    for (int number = 0; number < scenario_.coordinators; ++number) {
      if (!gone_.count(coordinator_process(number))) return false;
    }
    return true;
  }

  const RunOptions& options_;
  const Scenario& scenario_;
  const Placement& placement_;
  const NamespaceNetwork* network_;
  ProcessGroup group_;
  DdsBus bus_;
  RunMetrics judge_;
  Auditor auditor_;
  std::uint64_t said_violations_ = 0;
  std::optional<RecordingWriter> recording_;
  ProgressDisplay display_;
  std::atomic<bool> is_interrupted_{false};
  bool is_ready_ = false;
  std::size_t agents_started_ = 0;
  Time last_start_{};
  Time last_death_{};
  std::optional<Time> arrived_since_;
  std::set<std::string> gone_;  ///< processes that died and will not be restarted
  std::string failure_;
};

}  // namespace

int run(const RunOptions& given) {
  RunOptions options = given;
  const Scenario scenario = load_scenario(options.scenario_file);
  fmt::print(stderr, "{}\n", budget_line(budget_of(scenario), scenario.margin_m));
  const Hosts hosts =
      options.hosts_file.empty() ? local_hosts(options.dds.interface) : load_hosts(options.hosts_file);
  const Placement placement(hosts, scenario);
  options.dds.interface = hosts.interface;
  std::optional<NamespaceNetwork> network;
  std::optional<NamespaceVisit> visit;
  if (hosts.create) {
    remove_abandoned_namespaces();
    visit.emplace(network.emplace(hosts).hub());
  }
  const std::string report_path =
      options.report_file.empty() ? default_report_path(scenario.name, std::nullopt) : options.report_file;
  const std::string log_path = std::filesystem::path(report_path).replace_extension(".log").string();
  const Report report = Launcher(options, scenario, placement, network ? &*network : nullptr, log_path).run();
  write_report(report, report_path);
  fmt::print("\n{}: {}report: {}\nlog: {}\n", scenario.name, summary(report), report_path, log_path);
  return report.verdict().empty() ? 0 : kExitFailure;
}

}  // namespace sidestep
