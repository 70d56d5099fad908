// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
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
  /// For a process that drives robots: how long they may take to come to rest when it is asked to end. It
  /// ends before all processes that do not drive robots (0).
  std::chrono::milliseconds rest_time{0};
};

/// A child was restarted or died.
struct ChildEvent {
  enum class Kind { kStarted, kDied } kind = Kind::kStarted;
  std::string name;
  pid_t pid = 0;
  std::string reason;  ///< of the death, e.g. "exit code 3" or "signal 9 (SIGKILL)"
  bool will_restart = false;
};

/// The child processes of a run, with their log.
class Processes {
 public:
  using Milliseconds = std::chrono::milliseconds;

  virtual ~Processes() = default;

  /// Throws std::runtime_error when the program does not exist or the process cannot be created.
  virtual pid_t start(const ChildSpec& spec) = 0;
  /// Sends a signal to the running child of this name; false if none runs.
  [[nodiscard]] virtual bool send_signal(const std::string& name, int signal) = 0;
  /// Sends more to the stdin of the child of this name, and to the processes that replace it. Nothing happens
  /// if it was started without input.
  virtual void add_input(const std::string& name, const std::string& more) = 0;
  /// Starts the child of this name again by a new specification, as a new process: at the next poll(), or
  /// when the running one, which is killed, has ended. Throws std::runtime_error if no such child was ever
  /// started.
  virtual void restart(const ChildSpec& spec) = 0;
  /// Waits for events of children, at most for the timeout, and returns them. Restarts children that are due.
  virtual std::vector<ChildEvent> poll(Milliseconds timeout) = 0;
  /// Asks all children to end, those that drive robots before the others, kills those that have not ended
  /// after the timeout and their time to rest, and waits for all. Returns the names of the killed children.
  virtual std::vector<std::string> terminate(Milliseconds timeout) = 0;

  /// Of all children that have ended, by name. A child on another host counts as its connection.
  virtual std::map<std::string, ProcessUse> resource_use() const = 0;
  /// The last lines that a child printed, even after its end.
  virtual std::vector<std::string> last_lines(const std::string& name) const = 0;
  /// Writes a line to the log.
  virtual void log(const std::string& line) = 0;
};

}  // namespace sidestep
