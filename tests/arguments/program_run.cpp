// SPDX-License-Identifier: Apache-2.0
#include "tests/arguments/program_run.hpp"

#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <poll.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace sidestep::arguments {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

[[noreturn]] void execute(const std::string& program, std::vector<char*> arguments, const std::string& folder,
                          const std::string& errors) {
  const int none = open("/dev/null", O_RDWR), file = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(none, STDIN_FILENO);
  dup2(none, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
  if (chdir(folder.c_str()) == 0) execv(program.c_str(), arguments.data());
  _exit(127);
}

/// Whether the process ends within this time.
bool ends_within(int pidfd, std::chrono::milliseconds time) {
  pollfd entry{pidfd, POLLIN, 0};
  return poll(&entry, 1, static_cast<int>(time.count())) == 1;
}

}  // namespace

ProgramRun run_program(const std::vector<std::string>& command, const std::string& folder,
                       std::chrono::milliseconds patience, int signal) {
  const std::string program =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / command.at(0)).string();
  const std::string errors = folder + "/stderr";
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const auto begin = std::chrono::steady_clock::now();
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("cannot start a process");
  if (pid == 0) execute(program, arguments, folder, errors);
  const int pidfd = static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
  if (!ends_within(pidfd, patience)) {
    kill(pid, signal);
    if (!ends_within(pidfd, patience)) kill(pid, SIGKILL);
  }
  int status = 0;
  rusage usage{};
  wait4(pid, &status, 0, &usage);
  close(pidfd);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  std::ifstream stream(errors, std::ios::binary);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
          {std::istreambuf_iterator<char>(stream), {}},
          seconds(usage.ru_utime) + seconds(usage.ru_stime),
          wall.count(),
          static_cast<double>(usage.ru_maxrss) / 1024};
}

}  // namespace sidestep::arguments
