// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace sidestep {

/// Throws std::runtime_error unless the path is a regular file, because a device or pipe could block a
/// program or fill its memory. The message is only the reason, e.g. "it is a directory".
void require_regular_file(const std::string& path);

/// Reads a file whose path comes from a user. Throws std::runtime_error if it is not a regular file, exceeds
/// `max_bytes`, or cannot be read. The message is only the reason.
[[nodiscard]] std::string read_file(const std::string& path, std::size_t max_bytes);

}  // namespace sidestep
