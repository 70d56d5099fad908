// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace sidestep {

/// Why the user of this process has no permission to read a file or folder: "user sidestep may not read PATH:
/// FOLDER belongs to root and has mode 0700". nullopt if permissions are not the obstacle, for example
/// because the file does not exist. Follows links.
[[nodiscard]] std::optional<std::string> denied_read(const std::string& path);

/// Why the user of this process has no permission to write a file, or to make it in its folder; the text is
/// like that of denied_read(). If folders are missing, the last one that exists counts.
[[nodiscard]] std::optional<std::string> denied_write(const std::string& path);

/// Throws std::invalid_argument with the text of denied_read() if it returns one.
void require_read_permission(const std::string& path);

}  // namespace sidestep
