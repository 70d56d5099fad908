// SPDX-License-Identifier: Apache-2.0
#include "common/file/folder.hpp"

#include <cerrno>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>

#include "common/file/output_file.hpp"

namespace sidestep {

std::string try_create_folder(const std::string& folder) {
  std::error_code error, none;
  std::filesystem::create_directories(folder, error);
  const bool exists = std::filesystem::is_directory(folder, none);
  return exists ? "" : write_problem(folder, error ? error.value() : ENOTDIR);
}

void create_folder(const std::string& folder) {
  if (const std::string problem = try_create_folder(folder); !problem.empty())
    throw std::runtime_error(fmt::format("cannot create the folder {}: {}", folder, problem));
}

void create_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const std::string problem = folder.empty() ? "" : try_create_folder(folder);
  if (problem.empty()) return;
  std::error_code none;
  if (std::filesystem::exists(folder, none)) throw_unwritable(path, problem);
  throw_unwritable(path, fmt::format("cannot create the folder {}: {}", folder, problem));
}

}  // namespace sidestep
