// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace sidestep {

/// The content of a file that somebody names. Throws std::runtime_error with nothing but the reason, e.g. "a
/// directory": if it is no regular file, so that no device or pipe keeps the program waiting or fills its
/// memory, if it has more than `max_bytes`, or if it cannot be read.
[[nodiscard]] std::string read_file(const std::string& path, std::size_t max_bytes);

}  // namespace sidestep
