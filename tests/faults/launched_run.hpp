// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/messaging/dds/bus.hpp"
#include "common/motion/version.hpp"
#include "deploy/run/launch/hosts/namespaces.hpp"
#include "deploy/run/launch/process_group.hpp"
#include "tests/test_domain.hpp"

namespace sidestep {

std::string three_hosts_file();

/// `sidestep run` as started by a user, in its own DDS domain, observed through its output, the ground truth
/// on the bus and its report. No process of the run outlives this object. A sanitizer error in any of them
/// fails the test.
class LaunchedRun {
 public:
  /// `scenario` is the text of a scenario file. With the argument --keys, this object observes the run as a
  /// judge.
  explicit LaunchedRun(const std::string& scenario, const std::vector<std::string>& extra_arguments = {});
  /// Starts a run on the hosts of a hosts file that creates network namespaces. This thread stays in their
  /// network during the lifetime of the object. Needs root.
  static std::unique_ptr<LaunchedRun> on_namespaces(const std::string& scenario,
                                                    const std::vector<std::string>& extra_arguments = {},
                                                    const std::string& hosts_file = three_hosts_file());
  ~LaunchedRun();
  LaunchedRun(const LaunchedRun&) = delete;
  LaunchedRun& operator=(const LaunchedRun&) = delete;

  /// Receives messages until the condition holds; false on a timeout of one minute or when the run ends
  /// first.
  template <typename Condition>
  bool wait_until(Condition condition) {
    const Time deadline = bus_->now() + std::chrono::minutes(1);
    while (!condition()) {
      poll();
      if (bus_->now() > deadline) return false;
      if (exit_ && !condition()) return false;
    }
    return true;
  }
  /// Waits for the end of the run and returns the reason, e.g. "exit code 0"; empty on timeout.
  std::string wait_for_end();
  /// Starts another Sidestep program alongside the run; its output goes to the same log.
  pid_t start(const std::string& name, const std::string& program, const std::vector<std::string>& arguments);
  /// The exit reason of the program with this name, e.g. "exit code 0"; nullopt while the program runs.
  std::optional<std::string> exit_reason(const std::string& name) const;
  /// Runs `sidestep` with these arguments to its end and returns the reason, e.g. "exit code 0"; empty on
  /// timeout.
  std::string command(const std::vector<std::string>& arguments);
  /// The options --domain and --interface for joining the run.
  std::vector<std::string> dds_arguments() const;
  std::string scenario_file() const { return (folder_ / "scenario.yaml").string(); }
  /// The launcher's own process.
  pid_t pid() const { return pid_; }
  /// The launcher's child process that directs and observes the run; 0 if there is none.
  pid_t director() const;
  /// The latest process that was started with this name, e.g. "agent 3"; 0 if there is none.
  pid_t pid_of(const std::string& process) const;
  std::map<std::string, pid_t> children() const;
  /// The robots whose agents were started on the host.
  std::vector<RobotId> robots_on(const std::string& host) const;
  /// Whether the launcher or a program started alongside has printed this text.
  bool printed(const std::string& text) const;
  /// Whether a process of the run has printed this text.
  bool logged(const std::string& text) const;
  /// What the processes of the run have printed.
  std::string log() const;
  std::string output() const;

  DdsBus& bus() { return *bus_; }
  const DdsBus& bus() const { return *bus_; }
  const msg::GroundTruth& truth() const { return truth_; }
  double speed_mps(RobotId robot) const;
  double max_speed_mps() const;
  double max_speed_mps(const std::vector<RobotId>& robots) const;
  /// The report of the run; invalid JSON if there is none.
  nlohmann::json report() const;

 private:
  LaunchedRun(const std::string& scenario, const std::vector<std::string>& extra_arguments,
              const std::string& interface);
  void poll();
  void subscribe();
  void check_sanitizers() const;

  TestDomain domain_;
  std::string interface_;
  std::string keys_;
  std::filesystem::path folder_;
  ProcessGroup group_;
  std::optional<ScopedNamespace> visit_;
  std::unique_ptr<DdsBus> bus_;
  msg::GroundTruth truth_;
  std::map<std::string, std::string> exit_reasons_;  ///< exit reasons of programs started alongside the run
  std::optional<std::string> exit_;                  ///< exit reason of the run
  pid_t pid_ = 0;
};

/// Checks that the run has passed, or could not be judged because too many messages were missed. For tests in
/// which processes are forgotten for a while or packets are lost.
void check_passed_or_missed_messages(const LaunchedRun& run, const std::string& end);

/// The text of a shipped file below deploy/, e.g. "scenarios/crossing.yaml".
std::string shipped(const std::string& file);
std::string shipped_scenario(const std::string& name);
/// The scenario crossing-images. With a sanitizer, which makes rendering much slower, frames are fewer and
/// smaller.
std::string crossing_images(int rate_hz = 60);
/// A scenario with six robots that shuttle along their own lanes and two that cross all lanes, each `times`
/// times. `extra_keys` are added to the scenario.
std::string shuttles(int times, const std::string& extra_keys);
/// Fails the test unless the report exists and shows no contact, no firmware violation and no audit
/// violation. Does not require that the run was judged, which exit code 0 shows.
void require_no_violations(const nlohmann::json& report);
/// Whether a process with this id exists and is not a zombie.
bool is_running(pid_t pid);

}  // namespace sidestep
