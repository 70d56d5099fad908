// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// Writes a text file atomically, creating its folder if needed: readers see the old content or the new
/// content, never a part of it. A path that is not a regular file, such as /dev/stdout or a symbolic link, is
/// written in place. On failure, throws std::runtime_error ("cannot write PATH: reason"), and the old content
/// remains.
void write_file(const std::string& path, const std::string& text);

}  // namespace sidestep
