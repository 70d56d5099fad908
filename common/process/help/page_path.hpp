// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace sidestep {

/// Where the reader of a help text finds a page of this project, given its path in the source tree. A program
/// that is installed names the file that is installed with it; others name the path in the source tree.
[[nodiscard]] std::string page_path(const std::string& page);

/// The same for a program with this path.
[[nodiscard]] std::string page_path(const std::string& page, const std::filesystem::path& program);

}  // namespace sidestep
