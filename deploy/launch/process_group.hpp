// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <deque>
#include <memory>
#include <string>
#include <sys/types.h>
#include <vector>

namespace sidestep {

/// What to start.
struct ChildSpec {
  std::string name;               ///< e.g. "agent 3"
  std::vector<std::string> argv;  ///< the program's path first
  bool restart = false;           ///< again when it ends
  std::string input =
      {};  ///< its stdin, which then stays open: its end asks the child to end. Empty: no stdin
};

/// What has happened to a child.
struct ChildEvent {
  enum class Kind { kStarted, kDied } kind;
  std::string name;
  pid_t pid = 0;
  std::string reason;  ///< of a death: "exit code 3" or "signal 9 (SIGKILL)"
  bool will_restart = false;
};

/// Child processes that are watched, logged and never outlive this process: the kernel kills them with it,
/// however it ends. Use it from one thread that lives as long as the program (the kernel's watch is on the
/// thread).
class ProcessGroup {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;
  using Milliseconds = std::chrono::milliseconds;

  /// What children print goes to the log file line by line behind their names; throws std::runtime_error when
  /// it cannot be written.
  explicit ProcessGroup(const std::string& log_path);
  /// Kills what still runs.
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  /// Throws std::runtime_error when the program does not exist or no process can be made.
  pid_t start(const ChildSpec& spec);
  /// Waits until something has happened to a child, at most so long, and says what; starts again what is due.
  std::vector<ChildEvent> poll(Milliseconds timeout);
  /// Asks all children to end, kills those that have not after a while, and waits for them. Returns the names
  /// of those that had to be killed.
  std::vector<std::string> terminate(Milliseconds patience);

  std::size_t running() const;
  /// What a child printed last, also after its end.
  std::vector<std::string> last_lines(const std::string& name) const;
  /// Writes a line of the caller's into the log.
  void log(const std::string& line);

 private:
  struct Child;
  void spawn(Child& child);
  void wait_for_something(Milliseconds timeout);
  void drain(Child& child);
  bool reap(Child& child, ChildEvent& event);
  void start_due(std::vector<ChildEvent>& events);

  std::FILE* log_;
  std::vector<std::unique_ptr<Child>> children_;
  bool is_terminating_ = false;
};

/// The path of a program that lies beside the one that is running.
std::string program_beside_own(const std::string& name);

}  // namespace sidestep
