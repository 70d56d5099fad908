// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <ios>
#include <iterator>
#include <string>

namespace sidestep {

/// The content of a file; empty if it cannot be read, for example because it describes a process that ends
/// meanwhile.
inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  try {
    return {std::istreambuf_iterator<char>(file), {}};
  } catch (const std::ios_base::failure&) {
    return "";
  }
}

}  // namespace sidestep
