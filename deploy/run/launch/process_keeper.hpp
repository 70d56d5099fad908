// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "deploy/run/launch/process_group.hpp"

namespace sidestep {

/// What directs the processes of a run, in a process of its own: the director.
struct DirectorWork {
  /// Runs in the director, and returns its exit code. Its predecessors have died for these reasons, e.g.
  /// "signal 6 (SIGABRT)". Processes that one of them has started are not started again: start() returns the
  /// number of the existing process, and poll() names first those that have died for good.
  std::function<int(Processes&, const std::vector<std::string>& deaths)> run;
  /// Called in this process, after the end of all others, if the director died when it was asked to end, or
  /// while it ended the processes.
  std::function<void(const std::string& reason)> on_lost;
  /// A director that does not end so long after it was asked to is killed. Ctrl-C has no other effect until
  /// then if the director was stopped by a signal.
  std::chrono::milliseconds max_ending{30'000};
};

/// Runs the work in a director, which speaks with the network, while this process, which does not, keeps the
/// processes in the group. So they go on if the director dies by a signal; another one then takes its place,
/// after a pause that doubles with each, up to a minute. When a director ends, those that are left are ended
/// too. SIGINT and SIGTERM are passed on to the director. One that does not end in time, or 15 s after the
/// end of its processes, is killed. If this process dies, the director is asked to end, and finds that all
/// processes have ended.
///
/// Returns the exit code of the director, 1 if it was lost. Call it before this process starts threads.
/// Throws std::runtime_error if no process can be created.
int keep_processes(ProcessGroup& group, const DirectorWork& work);

}  // namespace sidestep
