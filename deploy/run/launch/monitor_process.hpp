// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deploy/run/launch/processes.hpp"
#include "deploy/run/launch/run.hpp"

namespace sidestep {

/// The name of the process that shows a run in the browser.
inline constexpr const char* kMonitorProcess = "monitor";

/// That process. Precondition: RunOptions::monitor_port is set. Throws std::invalid_argument if it has no
/// keys in a run with keys.
[[nodiscard]] ChildSpec monitor_child(const RunOptions& options);

/// The address of the page, with the token if viewers may command.
[[nodiscard]] std::string monitor_url(const RunOptions& options);

/// Throws std::invalid_argument if another program uses this TCP port of the loopback interface.
void require_free_port(const std::string& port);

}  // namespace sidestep
