// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <unistd.h>

namespace sidestep {

/// Captures stderr of this process during its lifetime.
class CaptureStderr {
 public:
  CaptureStderr() : file_(std::tmpfile()), saved_(dup(2)) {
    std::fflush(stderr);
    dup2(fileno(file_), 2);
  }
  ~CaptureStderr() {
    std::fflush(stderr);
    dup2(saved_, 2);
    close(saved_);
    std::fclose(file_);
  }
  CaptureStderr(const CaptureStderr&) = delete;
  CaptureStderr& operator=(const CaptureStderr&) = delete;

  std::string text() const {
    std::string result(1 << 16, '\0');
    const ssize_t size = pread(fileno(file_), result.data(), result.size(), 0);
    result.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return result;
  }
  bool has(const std::string& words) const { return text().find(words) != std::string::npos; }

 private:
  std::FILE* file_;
  int saved_;
};

}  // namespace sidestep
