// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/process/help/command_info.hpp"

namespace sidestep {

/// The man page of a program with all its commands, for section 1, in the macros of man(7).
[[nodiscard]] std::string man_page(const CommandInfo& program, const std::string& version);

}  // namespace sidestep
