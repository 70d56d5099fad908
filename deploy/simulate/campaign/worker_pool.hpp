// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace sidestep {

/// Does numbered jobs in child processes, one at a time in each, so that a job that crashes takes nothing
/// with it. To be used before this process has threads.
class WorkerPool {
 public:
  /// Runs in the children; what it returns is one line of text.
  using Work = std::function<std::string(std::uint64_t job)>;
  /// Runs here, as each job is done, in any order. `died` says why a worker has died of its job, then there
  /// is no line; empty: it has not.
  using Done = std::function<void(std::uint64_t job, const std::string& line, const std::string& died)>;

  /// `workers` > 0. Throws std::system_error when there can be no workers.
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
    std::string text;  // of a line that has not ended
  };
  void start(Worker& worker);
  /// Waits for the process; why it died.
  std::string stop(Worker& worker);
  void give(Worker& worker, std::uint64_t job);
  void hear(Worker& worker);

  Work work_;
  Done done_;
  std::vector<Worker> workers_;
};

}  // namespace sidestep
