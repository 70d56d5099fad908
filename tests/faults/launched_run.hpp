// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/messaging/dds_bus.hpp"
#include "common/motion/version.hpp"
#include "deploy/process_group.hpp"
#include "tests/own_domain.hpp"

namespace sidestep {

/// `sidestep run` as a user starts it, in a domain of its own, watched from outside: through what it prints,
/// the ground truth on the bus, and the report that it leaves. Whatever happens, nothing of it outlives this
/// object.
class LaunchedRun {
 public:
  /// `scenario` is the text of a scenario file.
  explicit LaunchedRun(const std::string& scenario, const std::vector<std::string>& more_arguments = {});
  ~LaunchedRun();
  LaunchedRun(const LaunchedRun&) = delete;
  LaunchedRun& operator=(const LaunchedRun&) = delete;

  /// Listens until the condition holds; false when it does not within a minute, or the run ends before.
  template <typename Condition>
  bool until(Condition condition) {
    const Time deadline = bus_.now() + std::chrono::minutes(1);
    while (!condition()) {
      listen();
      if (bus_.now() > deadline) return false;
      if (exit_ && !condition()) return false;
    }
    return true;
  }
  /// Waits for the end of the run: "exit code 0", or what else it died of; empty when it does not end.
  std::string wait_for_end();
  /// The launcher's own process.
  pid_t pid() const { return pid_; }
  /// The latest process that was started under this name, e.g. "agent 3"; 0 when there was none.
  pid_t pid_of(const std::string& process) const;
  std::map<std::string, pid_t> children() const;
  bool printed(const std::string& words) const;
  std::string output() const;

  const msg::GroundTruth& truth() const { return truth_; }
  double speed_mps(RobotId robot) const;
  double fastest_mps() const;
  /// What the run has left behind; a null value when there is no report.
  nlohmann::json report() const;

 private:
  void listen();

  OwnDomain domain_;
  std::filesystem::path folder_;
  ProcessGroup group_;
  DdsBus bus_;
  msg::GroundTruth truth_;
  std::optional<std::string> exit_;
  pid_t pid_ = 0;
};

/// A shipped scenario's text.
std::string shipped_scenario(const std::string& name);
/// Whether a process of this id exists (a zombie does not count).
bool is_running(pid_t pid);

}  // namespace sidestep
