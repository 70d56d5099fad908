// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace sidestep {

/// The path with a number before the extension: FOLDER/NAME-NUMBER.EXTENSION.
[[nodiscard]] std::string numbered_path(const std::filesystem::path& path, std::size_t number);

/// Creates an empty file and its folder. If the file exists, another one is created beside it: a-2.log,
/// a-3.log and so on. Processes that do so at the same time get different files. Returns the file's path.
/// Throws std::runtime_error ("cannot write PATH: reason").
[[nodiscard]] std::string create_new_file(const std::string& path);

}  // namespace sidestep
