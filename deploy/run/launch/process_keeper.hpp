// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "deploy/run/launch/process_group.hpp"

namespace sidestep {

/// The work of the director, a separate process that directs the processes of a run.
struct DirectorWork {
  /// Runs in the director, and returns its exit code. `deaths` are the reasons for which its predecessors
  /// died, e.g. "signal 6 (SIGABRT)". Processes that a predecessor has started are not started again: start()
  /// returns the pid of the existing process, and poll() first reports processes that have died permanently.
  std::function<int(Processes&, const std::vector<std::string>& deaths)> run;
  /// Called in this process, once all other processes have ended, if the director died after it was asked to
  /// end, or while it was ending the processes.
  std::function<void(const std::string& reason)> on_director_lost;
  /// A director that has not ended this long after it was asked to end is killed. If a signal has stopped the
  /// director, Ctrl-C takes effect only then.
  std::chrono::milliseconds shutdown_timeout{30'000};
  /// A director that has not ended this long after its processes have ended is killed.
  std::chrono::milliseconds exit_timeout{15'000};
  /// Called in this process when the director has ended and processes that outlast the run remain.
  std::function<void()> on_outlasting{};
};

/// Runs the work in a separate process, the director, which uses the network. This process does not use the
/// network, and keeps the processes in the group. So they continue if a signal kills the director. Another
/// director then takes its place, after a pause that doubles each time, up to a minute. When a director ends,
/// the remaining processes are also ended. SIGINT and SIGTERM are passed on to the director as SIGTERM, which
/// may arrive repeatedly, and a further SIGINT as SIGINT. A director that does not end in time is killed. If
/// this process dies, the director is asked to end, and finds that all processes have ended.
///
/// Processes that outlast the run (ChildSpec::outlasts_run) continue after a director has ended with an exit
/// code, until they end themselves, or SIGINT or SIGTERM arrives, possibly before the director's end.
///
/// Returns the exit code of the director, or 1 if the director was lost. Call it before this process starts
/// threads. Throws std::runtime_error if no process can be created.
int keep_processes(ProcessGroup& group, const DirectorWork& work);

}  // namespace sidestep
