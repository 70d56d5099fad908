// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/process/help/command_info.hpp"

namespace sidestep {

/// What --help prints, in lines of at most `width` columns unless a single word is longer.
[[nodiscard]] std::string help_text(const CommandInfo& command, std::size_t width);

/// The columns of the terminal on stdout, but at least 60 and at most 120; 100 if stdout is not a terminal.
[[nodiscard]] std::size_t help_width();

/// The first column of an option's row: "-h, --help" or "--peers TEXT,...".
[[nodiscard]] std::string option_heading(const OptionInfo& option);

}  // namespace sidestep
