// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/worker_pool.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "common/file/console.hpp"

namespace sidestep {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

bool read_all(int fd, void* data, std::size_t size) {
  auto* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = read(fd, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

bool write_all(int fd, const void* data, std::size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t put = write(fd, at, size);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    at += put;
    size -= static_cast<std::size_t>(put);
  }
  return true;
}

[[noreturn]] void run_worker(int jobs, int lines, const WorkerPool::Work& work) {
  std::uint64_t job = 0;
  try {
    while (read_all(jobs, &job, sizeof job)) {
      const std::string line = work(job) + "\n";
      if (!write_all(lines, line.data(), line.size())) break;
    }
  } catch (const std::exception& error) {
    print_to(stderr, "job {}: {}\n", job, error.what());
    _exit(1);
  }
  _exit(0);
}

}  // namespace

WorkerPool::WorkerPool(int workers, Work work, Done done)
    : work_(std::move(work)), done_(std::move(done)), workers_(static_cast<std::size_t>(workers)) {
  std::signal(SIGPIPE, SIG_IGN);
  for (Worker& worker : workers_) start(worker);
}

WorkerPool::~WorkerPool() {
  for (Worker& worker : workers_) stop(worker);
}

void WorkerPool::start(Worker& worker) {
  int jobs[2], lines[2];
  if (pipe(jobs) != 0 || pipe(lines) != 0) fail("cannot create a pipe to a worker");
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid < 0) fail("cannot start a worker");
  if (pid == 0) {
    // Close inherited pipe ends: a worker sees the end of its jobs only when no process holds the write end.
    for (const Worker& other : workers_) {
      if (other.jobs >= 0) close(other.jobs);
      if (other.lines >= 0) close(other.lines);
    }
    close(jobs[1]);
    close(lines[0]);
    run_worker(jobs[0], lines[1], work_);
  }
  close(jobs[0]);
  close(lines[1]);
  worker = {pid, jobs[1], lines[0], 0, false, {}};
}

std::string WorkerPool::stop(Worker& worker) {
  if (worker.pid < 0) return {};
  close(worker.jobs);
  close(worker.lines);
  int status = 0;
  while (waitpid(worker.pid, &status, 0) < 0 && errno == EINTR) {
  }
  worker = {};
  if (WIFSIGNALED(status))
    return fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  return fmt::format("exit code {}", WEXITSTATUS(status));
}

void WorkerPool::assign(Worker& worker, std::uint64_t job) {
  worker.job = job;
  worker.is_busy = true;
  // If this fails, the worker is dead, which receive() detects.
  (void)write_all(worker.jobs, &job, sizeof job);
}

void WorkerPool::receive(Worker& worker) {
  char buffer[4096];
  const ssize_t got = read(worker.lines, buffer, sizeof buffer);
  if (got < 0 && errno == EINTR) return;
  if (got <= 0) {
    const std::uint64_t job = worker.job;
    const std::string death_reason = stop(worker);
    start(worker);
    done_(job, "", death_reason);
    return;
  }
  worker.text.append(buffer, static_cast<std::size_t>(got));
  if (worker.text.back() != '\n') return;
  worker.text.pop_back();
  worker.is_busy = false;
  done_(worker.job, std::exchange(worker.text, {}), "");
}

void WorkerPool::run(const std::vector<std::uint64_t>& jobs) {
  auto next = jobs.begin();
  for (;;) {
    std::vector<pollfd> waiting;
    for (Worker& worker : workers_) {
      if (!worker.is_busy && next != jobs.end()) assign(worker, *next++);
      waiting.push_back({worker.is_busy ? worker.lines : -1, POLLIN, 0});
    }
    const bool is_any_busy = std::ranges::any_of(workers_, &Worker::is_busy);
    if (!is_any_busy) return;
    if (poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) fail("cannot wait for workers");
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (waiting[i].revents != 0) receive(workers_[i]);
    }
  }
}

}  // namespace sidestep
