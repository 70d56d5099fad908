// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// The version of Sidestep, for example "0.1.0". All programs, the client library, the package and its CMake
/// files have it from project() in the CMakeLists.txt of the root.
extern const char* const kVersion;

/// The commit that this program was built from, with the suffix "-changed" if files were modified; "unknown"
/// without git.
extern const char* const kBuildCommit;

/// What --version prints: "Sidestep 0.1.0, commit 4252e8655f77, Fast DDS 2.9.1".
[[nodiscard]] std::string version_text(const std::string& fast_dds_version);

}  // namespace sidestep
