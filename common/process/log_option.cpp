// SPDX-License-Identifier: Apache-2.0
#include "common/process/log_option.hpp"

namespace sidestep {

ValueCheck log_level_names() { return one_of({kLogLevelNames.begin(), kLogLevelNames.end()}); }

Option add_log_option(const CliCommand& app, LogLevel& level) {
  return app
      .add_option(
          "--log-level", [&level](const std::string& name) { level = *log_level_from(name); },
          "lowest severity of messages in the log")
      .check(log_level_names())
      .show_default(std::string(to_text(level)));
}

}  // namespace sidestep
