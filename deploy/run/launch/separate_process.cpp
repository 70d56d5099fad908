// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/separate_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/process/exit_code.hpp"
#include "deploy/run/launch/process_group.hpp"

namespace sidestep {

int run_separately(const std::function<int()>& work) {
  std::fflush(nullptr);
  const pid_t parent = getpid(), pid = fork();
  if (pid < 0) throw std::runtime_error(std::string("cannot start a process: ") + std::strerror(errno));
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) std::_Exit(kExitFailure);  // the parent died before the line above
    // Does not run the destructors of the parent's objects.
    std::exit(work());
  }
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status)) throw std::runtime_error("a process died: " + reason_of(status));
  return WEXITSTATUS(status);
}

}  // namespace sidestep
