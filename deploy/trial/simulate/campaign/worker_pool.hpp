// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace sidestep {

/// Runs numbered jobs in child processes, one job per process at a time, so that a crash affects only its own
/// job. Must be created before this process has threads.
class WorkerPool {
 public:
  /// The work of a job; runs in a child and returns one line of text.
  using Work = std::function<std::string(std::uint64_t job)>;
  /// Called in this process after each job, in any order. If the worker died, `death_reason` is not empty and
  /// there is no line.
  using Done =
      std::function<void(std::uint64_t job, const std::string& line, const std::string& death_reason)>;

  /// Precondition: workers > 0. Throws std::system_error if a worker cannot be started.
  WorkerPool(int workers, Work work, Done done);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Returns when all jobs are done.
  void run(const std::vector<std::uint64_t>& jobs);

 private:
  struct Worker {
    pid_t pid = -1;
    int jobs = -1, lines = -1;  // ends of pipes
    std::uint64_t job = 0;
    bool is_busy = false;
    std::string text;  // text of an incomplete line
  };
  void start(Worker& worker);
  /// Waits for the end of the process and returns the reason.
  std::string stop(Worker& worker);
  void assign(Worker& worker, std::uint64_t job);
  void receive(Worker& worker);

  Work work_;
  Done done_;
  std::vector<Worker> workers_;
};

}  // namespace sidestep
