// SPDX-License-Identifier: Apache-2.0
#include "common/file/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace sidestep {

namespace {

[[noreturn]] void fail(const std::string& folder, const std::string& reason) {
  throw std::runtime_error("cannot create a temporary folder in " + folder + ": " + reason);
}

/// The folder that TMPDIR or a similar variable names, or /tmp.
std::filesystem::path parent_folder() {
  std::error_code error;
  const auto folder = std::filesystem::temp_directory_path(error);
  const char* const named = std::getenv("TMPDIR");
  if (error) fail(named ? named : "/tmp", error.message());
  return folder;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  const std::filesystem::path folder = parent_folder();
  path_ = (folder / "sidestep-XXXXXX").string();
  if (mkdtemp(path_.data()) == nullptr) fail(folder.string(), std::strerror(errno));
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

}  // namespace sidestep
