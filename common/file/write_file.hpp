// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

namespace sidestep {

/// Writes a text file atomically, creating its folder if needed: readers see the old content or the new
/// content, never a part of it. A path that is not a regular file, such as /dev/stdout or a symbolic link, is
/// written in place. On failure, throws std::runtime_error ("cannot write PATH: reason"), and the old content
/// remains.
void write_file(const std::string& path, const std::string& text);

/// Like write_file(), but returns what it would throw as text, for work that goes on; empty on success.
[[nodiscard]] std::string try_write_file(const std::string& path, const std::string& text);

/// Throws std::runtime_error with all problems that try_write_file() returned, unless all are empty.
void require_written(std::initializer_list<std::string> problems);

/// Checks, before work whose result goes to a file, that write_file() could write the file now, and creates
/// its folder. Leaves the file as it is. Throws what write_file() would throw.
void require_replaceable(const std::string& path);

/// The same for a file that open_output() opens, which must be in an existing folder. Throws what
/// open_output() would throw.
void require_openable(const std::string& path);

}  // namespace sidestep
