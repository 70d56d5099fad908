// SPDX-License-Identifier: Apache-2.0
#include "common/file/new_file.hpp"

#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "common/file/folder.hpp"
#include "common/file/output_file.hpp"

namespace sidestep {

std::string numbered_path(const std::filesystem::path& path, std::size_t number) {
  const std::string name = fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string());
  return (path.parent_path() / name).string();
}

std::string create_new_file(const std::string& path) {
  create_folder_of(path);
  std::string file = path;
  for (std::size_t number = 2;; ++number) {
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      close(descriptor);
      return file;
    }
    if (errno != EEXIST) throw_unwritable(file, write_problem(file, errno));
    file = numbered_path(path, number);
  }
}

}  // namespace sidestep
