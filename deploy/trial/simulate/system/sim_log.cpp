// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/system/sim_log.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "common/file/console.hpp"
#include "common/log/log.hpp"

namespace sidestep {

void log_events_of(SimSystem& system, LogLevel level) {
  set_up_log("sidestep", level);
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  system.on_event(level, [&system, is_terminal](const std::string& process, const LogEvent& event) {
    if (is_terminal) print_to(stderr, "\r\x1b[K");  // erases the progress line
    log(event.level,
        fmt::format("{:.3f} s {}: {}", to_seconds(system.now() - system.begin()), process, event.text));
  });
}

}  // namespace sidestep
