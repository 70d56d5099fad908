// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

#include "deploy/audit/metrics/process_use.hpp"

namespace sidestep {

/// A child process to start.
struct ChildSpec {
  std::string name;               ///< for example "agent 3"
  std::vector<std::string> argv;  ///< the program's path first
  bool restart = false;           ///< restart it when it ends
  /// Content of its stdin, which then stays open; closing it asks the child to end. Empty: no stdin.
  std::string input = {};
  int niceness = 0;  ///< nice value, 0 .. 19: higher values yield more to other processes; see nice(2)
  /// For a process that drives robots: the maximum time for robots to come to rest when it is asked to end.
  /// Such a process ends before all processes that do not drive robots, whose rest_time is 0.
  std::chrono::milliseconds rest_time{0};
  /// terminate() spares it, so that it outlasts the run; see keep_processes().
  bool outlasts_run = false;
};

/// A child was restarted or died.
struct ChildEvent {
  enum class Kind { kStarted, kDied } kind = Kind::kStarted;
  std::string name;
  pid_t pid = 0;
  std::string reason;  ///< reason of the death, for example "exit code 3" or "signal 9 (SIGKILL)"
  bool will_restart = false;
};

/// The child processes of a run and their log.
class Processes {
 public:
  using Milliseconds = std::chrono::milliseconds;

  virtual ~Processes() = default;

  /// Starts a child. Throws std::runtime_error if the program is missing or the process cannot be created.
  virtual pid_t start(const ChildSpec& spec) = 0;
  /// Sends a signal to the running child with this name. False if none is running.
  [[nodiscard]] virtual bool send_signal(const std::string& name, int signal) = 0;
  /// Sends more input to the stdin of the child with this name, and of processes that replace it. No effect
  /// if it was started without input.
  virtual void add_input(const std::string& name, const std::string& more) = 0;
  /// Restarts the child with this name with a new specification, as a new process. This happens at the next
  /// poll(), or when the running process, which is killed, has ended. Throws std::runtime_error if no such
  /// child was ever started.
  virtual void restart(const ChildSpec& spec) = 0;
  /// Waits for events of children, up to the timeout, and returns them. Restarts children that are due.
  virtual std::vector<ChildEvent> poll(Milliseconds timeout) = 0;
  /// Asks the running child with this name to end, and does not start it again, not even if it is about to be
  /// restarted. Does not wait. False if none is running.
  [[nodiscard]] virtual bool ask_to_end(const std::string& name) = 0;
  /// Ends all children at once, except those that outlast the run: kills them, but only asks those that drive
  /// robots, and does not wait for these.
  virtual void abandon() = 0;
  /// Asks all children to end, those that drive robots before the others. Kills those that have not ended
  /// after the timeout plus their rest time, and waits for all to end. Returns the names of the killed
  /// children. Children that outlast the run continue.
  virtual std::vector<std::string> terminate(Milliseconds timeout) = 0;

  /// Resource use of all children that have ended, by name. For a child on another host, the resource use of
  /// its ssh connection.
  virtual std::map<std::string, ProcessUse> resource_use() const = 0;
  /// The last lines printed by a child, even after its end.
  virtual std::vector<std::string> last_lines(const std::string& name) const = 0;
  /// Writes a line to the log.
  virtual void log(const std::string& line) = 0;
};

}  // namespace sidestep
