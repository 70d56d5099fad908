// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>
#include <cstddef>
#include <sys/resource.h>

namespace sidestep {

/// Makes writing any file beyond this size fail in this process and its children, as if the disk were full
/// from there on.
inline bool limit_files(std::size_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  return setrlimit(RLIMIT_FSIZE, &limit) == 0;
}

}  // namespace sidestep
