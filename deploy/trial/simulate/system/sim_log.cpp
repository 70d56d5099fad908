// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/system/sim_log.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "common/file/console.hpp"
#include "common/log/log.hpp"
#include "common/terminal/redrawn_text.hpp"
#include "common/terminal/terminal.hpp"

namespace sidestep {

void log_events_of(SimSystem& system, LogLevel level) {
  set_up_log("sidestep", level);
  const bool has_progress = terminal_of(STDERR_FILENO).can_redraw;
  system.on_event(level, [&system, has_progress](const std::string& process, const LogEvent& event) {
    if (has_progress) print_to(stderr, "{}", kEraseLine);
    log(event.level,
        fmt::format("{:.3f} s {}: {}", to_seconds(system.now() - system.begin()), process, event.text));
  });
}

}  // namespace sidestep
