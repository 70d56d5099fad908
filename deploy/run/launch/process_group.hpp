// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <sys/types.h>
#include <vector>

#include "deploy/run/launch/processes.hpp"

namespace sidestep {

/// Supervises and logs child processes. When this process ends in any way, the kernel kills the children,
/// except children that drive robots: those are asked to end. Use it only from one thread that lives as long
/// as the program, because the kernel monitors the thread that forked.
class ProcessGroup : public Processes {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;

  /// The children's output goes to the log file, each line prefixed with the child's name. Throws
  /// std::runtime_error if the log cannot be written.
  explicit ProcessGroup(const std::string& log_path);
  /// Asks children that drive robots to end, and kills all others.
  ~ProcessGroup() override;
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  pid_t start(const ChildSpec& spec) override;
  [[nodiscard]] bool send_signal(const std::string& name, int signal) override;
  void add_input(const std::string& name, const std::string& more) override;
  void restart(const ChildSpec& spec) override;
  std::vector<ChildEvent> poll(Milliseconds timeout) override { return poll(timeout, {}); }
  /// Like poll(), but also returns as soon as one of these descriptors is readable.
  std::vector<ChildEvent> poll(Milliseconds timeout, std::span<const int> descriptors);
  [[nodiscard]] bool ask_to_end(const std::string& name) override;
  void abandon() override;
  std::vector<std::string> terminate(Milliseconds timeout) override;
  /// Like terminate(), but also ends the children that outlast the run.
  std::vector<std::string> terminate_all(Milliseconds timeout);

  /// The number of running children, except those that outlast the run.
  std::size_t running() const;
  /// Whether a child that outlasts the run is running.
  bool has_outlasting() const;
  std::map<std::string, ProcessUse> resource_use() const override { return resource_use_; }
  std::vector<std::string> last_lines(const std::string& name) const override;
  void log(const std::string& line) override;

 private:
  struct Child;
  /// The latest child of this name, or nullptr.
  Child* find(const std::string& name);
  void spawn(Child& child);
  /// Waits for children, descriptors, a due restart or the timeout. Returns whether a descriptor is readable.
  bool wait_for_activity(Milliseconds timeout, std::span<const int> descriptors);
  void drain(Child& child);
  void send_input(Child& child);
  bool reap(Child& child, ChildEvent& event);
  static void release(Child& child);
  void start_due(std::vector<ChildEvent>& events);
  static bool drives_robots(const Child& child);
  static void ask(Child& child);
  using Selection = std::function<bool(const Child&)>;
  bool has_running(const Selection& selection) const;
  /// Asks children to end, and waits for them up to the timeout.
  void end_all(Milliseconds timeout, const Selection& should_end);
  /// See terminate().
  std::vector<std::string> terminate(Milliseconds timeout, const Selection& should_end);

  std::string log_path_;
  std::FILE* log_;
  bool has_lost_lines_ = false;  ///< whether a line could not be written to the log
  std::vector<std::unique_ptr<Child>> children_;
  std::map<std::string, ProcessUse> resource_use_;
  bool is_terminating_ = false;
};

/// Why a process ended, from its status (see wait(2)), for example "exit code 3" or "signal 9 (SIGKILL)".
std::string reason_of(int status);

/// The path of a program in the folder of the running program.
std::string sibling_program_path(const std::string& name);

}  // namespace sidestep
