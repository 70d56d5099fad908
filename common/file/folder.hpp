// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// Creates a folder and those above it. Returns why that failed; empty if the folder exists now.
[[nodiscard]] std::string try_create_folder(const std::string& folder);

/// Creates a folder and those above it. Throws std::runtime_error ("cannot create the folder FOLDER:
/// reason").
void create_folder(const std::string& folder);

/// Creates the folder of a file. Throws std::runtime_error ("cannot write PATH: reason").
void create_folder_of(const std::string& path);

}  // namespace sidestep
