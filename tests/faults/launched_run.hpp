// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/messaging/dds/dds_bus.hpp"
#include "common/motion/version.hpp"
#include "deploy/launch/hosts/namespaces.hpp"
#include "deploy/launch/process_group.hpp"
#include "tests/own_domain.hpp"

namespace sidestep {

/// The path of the shipped hosts file.
std::string three_hosts_file();

/// `sidestep run` as a user starts it, in a domain of its own, watched from outside: through what it prints,
/// the ground truth on the bus, and the report that it leaves. Whatever happens, nothing of it outlives this
/// object, and a sanitizer's complaint about any process of it fails the test.
class LaunchedRun {
 public:
  /// `scenario` is the text of a scenario file.
  explicit LaunchedRun(const std::string& scenario, const std::vector<std::string>& more_arguments = {});
  /// On the three hosts of a hosts file, the shipped one. This thread stays in their network as long as the
  /// run lives. Needs root.
  static std::unique_ptr<LaunchedRun> on_three_hosts(const std::string& scenario,
                                                     const std::vector<std::string>& more_arguments = {},
                                                     const std::string& hosts_file = three_hosts_file());
  ~LaunchedRun();
  LaunchedRun(const LaunchedRun&) = delete;
  LaunchedRun& operator=(const LaunchedRun&) = delete;

  /// Listens until the condition holds; false when it does not within a minute, or the run ends before.
  template <typename Condition>
  bool until(Condition condition) {
    const Time deadline = bus_->now() + std::chrono::minutes(1);
    while (!condition()) {
      listen();
      if (bus_->now() > deadline) return false;
      if (exit_ && !condition()) return false;
    }
    return true;
  }
  /// Waits for the end of the run: "exit code 0", or what else it died of; empty when it does not end.
  std::string wait_for_end();
  /// Starts another program of ours beside the run, logged with it, and goes on.
  pid_t start(const std::string& name, const std::string& program, const std::vector<std::string>& arguments);
  /// Whether that has ended, and how: "exit code 0".
  std::optional<std::string> exit_of(const std::string& name) const;
  /// Runs `sidestep` with these arguments to its end, which it returns; empty when it does not end.
  std::string command(const std::vector<std::string>& arguments);
  /// "--domain N --interface A": how to take part.
  std::vector<std::string> dds_arguments() const;
  std::string scenario_file() const { return (folder_ / "scenario.yaml").string(); }
  /// The launcher's own process.
  pid_t pid() const { return pid_; }
  /// The latest process that was started under this name, e.g. "agent 3"; 0 when there was none.
  pid_t pid_of(const std::string& process) const;
  std::map<std::string, pid_t> children() const;
  /// The robots whose agents were started on the host.
  std::vector<RobotId> robots_on(const std::string& host) const;
  bool printed(const std::string& words) const;
  /// Whether a process of the run has said so.
  bool logged(const std::string& words) const;
  std::string output() const;

  DdsBus& bus() { return *bus_; }
  const msg::GroundTruth& truth() const { return truth_; }
  double speed_mps(RobotId robot) const;
  double fastest_mps() const;
  double fastest_mps(const std::vector<RobotId>& robots) const;
  /// What the run has left behind; a null value when there is no report.
  nlohmann::json report() const;

 private:
  LaunchedRun(const std::string& scenario, const std::vector<std::string>& more_arguments,
              const std::string& interface);
  void listen();
  void watch();
  void check_sanitizers() const;

  OwnDomain domain_;
  std::string interface_;
  std::filesystem::path folder_;
  ProcessGroup group_;
  std::optional<NamespaceVisit> visit_;
  std::unique_ptr<DdsBus> bus_;
  msg::GroundTruth truth_;
  std::map<std::string, std::string> exits_;
  std::optional<std::string> exit_;
  pid_t pid_ = 0;
};

/// A shipped file's text, e.g. "scenarios/crossing.yaml".
std::string shipped(const std::string& file);
/// A shipped scenario's text.
std::string shipped_scenario(const std::string& name);
/// crossing-images; with a sanitizer, which makes rendering many times as slow, fewer and smaller frames.
std::string crossing_images();
/// Six robots that shuttle along lanes of their own and two that cross all lanes, each so many times; `more`
/// are further keys of the scenario.
std::string shuttles(int times, const std::string& more);
/// Fails the test unless the report is there and says that nobody touched and no firmware rule was broken.
void require_untouched(const nlohmann::json& report);
/// Whether a process of this id exists (a zombie does not count).
bool is_running(pid_t pid);

}  // namespace sidestep
