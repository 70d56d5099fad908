// SPDX-License-Identifier: Apache-2.0
#include "common/file/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>
#include <unistd.h>

#include "common/file/permission.hpp"

namespace sidestep {
namespace {

namespace fs = std::filesystem;

}  // namespace

void throw_unwritable(const std::string& path, const std::string& reason) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", path, reason));
}

std::string write_problem(const std::string& path, int error) {
  std::error_code none;
  if (error == ENXIO && fs::is_fifo(path, none)) return "no process reads this pipe";
  if (error == EACCES) {
    if (const auto denied = denied_write(path)) return *denied;
  }
  const fs::path folder = fs::path(path).parent_path();
  const bool lacks_folder = error == ENOENT && !folder.empty() && !fs::exists(folder, none);
  return lacks_folder ? fmt::format("the folder {} does not exist", folder.string()) : std::strerror(error);
}

OutputFile open_output(const std::string& path, WriteMode mode) {
  const bool appends = mode == WriteMode::kAppend;
  const int descriptor =
      open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK | (appends ? O_APPEND : O_TRUNC), 0666);
  if (descriptor < 0) throw_unwritable(path, write_problem(path, errno));
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);  // writing may block
  OutputFile file(fdopen(descriptor, appends ? "a" : "w"));
  if (file) return file;
  const std::string reason = std::strerror(errno);
  close(descriptor);
  throw_unwritable(path, reason);
}

}  // namespace sidestep
