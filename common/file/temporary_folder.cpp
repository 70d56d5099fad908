// SPDX-License-Identifier: Apache-2.0
#include "common/file/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace sidestep {

TemporaryFolder::TemporaryFolder()
    : path_((std::filesystem::temp_directory_path() / "sidestep-XXXXXX").string()) {
  if (mkdtemp(path_.data()) == nullptr)
    throw std::runtime_error("cannot create a temporary folder: " + std::string(std::strerror(errno)));
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

}  // namespace sidestep
