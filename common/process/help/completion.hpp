// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/process/help/command_info.hpp"

namespace sidestep {

// Scripts with which a shell completes the commands, options and values of a program. Where the value is a
// text without choices, they offer the names of files.

[[nodiscard]] std::string bash_completion(const CommandInfo& program);
[[nodiscard]] std::string zsh_completion(const CommandInfo& program);
[[nodiscard]] std::string fish_completion(const CommandInfo& program);

/// The program's path as the name of a function: "sidestep_agent".
[[nodiscard]] std::string function_name(const std::string& path);

/// The text in single quotes, as bash and zsh read it.
[[nodiscard]] std::string in_single_quotes(const std::string& text);

}  // namespace sidestep
