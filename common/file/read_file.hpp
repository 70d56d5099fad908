// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace sidestep {

/// Throws std::runtime_error with nothing but the reason, e.g. "a directory", if there is no regular file: no
/// device or pipe may keep a program waiting or fill its memory.
void require_regular_file(const std::string& path);

/// The content of a file that somebody names. Throws std::runtime_error with nothing but the reason: if
/// it is no regular file, has more than `max_bytes`, or cannot be read.
[[nodiscard]] std::string read_file(const std::string& path, std::size_t max_bytes);

}  // namespace sidestep
