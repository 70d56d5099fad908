// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <sys/types.h>
#include <vector>

#include "deploy/monitor/metrics/process_use.hpp"

namespace sidestep {

/// A child process to start.
struct ChildSpec {
  std::string name;               ///< e.g. "agent 3"
  std::vector<std::string> argv;  ///< the program's path first
  bool restart = false;           ///< restart it when it ends
  /// Content of its stdin, which then stays open; closing it asks the child to end. Empty: no stdin.
  std::string input = {};
  int niceness = 0;  ///< how far it gives way to other processes, 0 .. 19, see nice(2)
};

/// A child was restarted or died.
struct ChildEvent {
  enum class Kind { kStarted, kDied } kind = Kind::kStarted;
  std::string name;
  pid_t pid = 0;
  std::string reason;  ///< of the death, e.g. "exit code 3" or "signal 9 (SIGKILL)"
  bool will_restart = false;
};

/// Supervises and logs child processes. The kernel kills the children when this process ends, however it
/// ends. Use it only from one thread that lives as long as the program, because the kernel monitors the
/// thread that forked.
class ProcessGroup {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;
  using Milliseconds = std::chrono::milliseconds;

  /// The output of children goes to the log file, each line prefixed with the child's name. Throws
  /// std::runtime_error when the log cannot be written.
  explicit ProcessGroup(const std::string& log_path);
  /// Kills all running children.
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  /// Throws std::runtime_error when the program does not exist or the process cannot be created.
  pid_t start(const ChildSpec& spec);
  /// Sends a signal to the running child of this name; false if none runs.
  [[nodiscard]] bool send_signal(const std::string& name, int signal);
  /// Sends more to the stdin of the child of this name, and to the processes that replace it. Nothing happens
  /// if it was started without input.
  void add_input(const std::string& name, const std::string& more);
  /// Starts the child of this name again by a new specification, as a new process: at the next poll(), or
  /// when the running one, which is killed, has ended. Throws std::runtime_error if no such child was ever
  /// started.
  void restart(const ChildSpec& spec);
  /// Waits for events of children, at most for the timeout, and returns them. Restarts children that are due.
  std::vector<ChildEvent> poll(Milliseconds timeout);
  /// Asks all children to end, kills those that have not ended after the timeout, and waits for all. Returns
  /// the names of the killed children.
  std::vector<std::string> terminate(Milliseconds timeout);

  std::size_t running() const;
  /// Of all children that have ended, by name. A child on another host counts as its connection.
  const std::map<std::string, ProcessUse>& resource_use() const { return resource_use_; }
  /// The last lines that a child printed, even after its end.
  std::vector<std::string> last_lines(const std::string& name) const;
  /// Writes a line to the log.
  void log(const std::string& line);

 private:
  struct Child;
  /// The latest child of this name, or nullptr.
  Child* find(const std::string& name);
  void spawn(Child& child);
  void wait_for_activity(Milliseconds timeout);
  void drain(Child& child);
  void send_input(Child& child);
  bool reap(Child& child, ChildEvent& event);
  void start_due(std::vector<ChildEvent>& events);

  std::FILE* log_;
  std::vector<std::unique_ptr<Child>> children_;
  std::map<std::string, ProcessUse> resource_use_;
  bool is_terminating_ = false;
};

/// The path of a program in the folder of the running program.
std::string sibling_program_path(const std::string& name);

}  // namespace sidestep
