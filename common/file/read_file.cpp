// SPDX-License-Identifier: Apache-2.0
#include "common/file/read_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

namespace sidestep {

void require_regular_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error) throw std::runtime_error(error.message());
  if (fs::is_directory(status)) throw std::runtime_error("it is a directory");
  if (!fs::is_regular_file(status)) throw std::runtime_error("it is not a regular file");
}

std::string read_file(const std::string& path, std::size_t max_bytes) {
  require_regular_file(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(std::strerror(errno));
  // The size is not known in advance: the file may grow meanwhile, and files in /proc report no size.
  std::string text;
  char buffer[1 << 16];
  while (file.read(buffer, sizeof buffer) || file.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(file.gcount()));
    if (text.size() > max_bytes)
      throw std::runtime_error(fmt::format("it is larger than {} MB", max_bytes / 1'000'000));
  }
  if (file.bad()) throw std::runtime_error("a read error occurred");
  return text;
}

}  // namespace sidestep
