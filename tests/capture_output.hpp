// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <unistd.h>

namespace sidestep {

/// Captures what this process writes to a stream, until finish() or the end of its lifetime.
class CapturedStream {
 public:
  explicit CapturedStream(std::FILE* stream) : stream_(stream), file_(std::tmpfile()) {
    std::fflush(stream_);
    saved_ = dup(fileno(stream_));
    dup2(fileno(file_), fileno(stream_));
  }
  ~CapturedStream() {
    finish();
    std::fclose(file_);
  }
  CapturedStream(const CapturedStream&) = delete;
  CapturedStream& operator=(const CapturedStream&) = delete;

  std::string text() const {
    std::fflush(stream_);
    std::string result(1 << 16, '\0');
    const ssize_t size = pread(fileno(file_), result.data(), result.size(), 0);
    result.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return result;
  }
  bool has(const std::string& words) const { return text().find(words) != std::string::npos; }
  /// Ends the capture, and returns the text.
  std::string finish() {
    const std::string captured = text();
    if (saved_ >= 0) {
      dup2(saved_, fileno(stream_));
      close(saved_);
      saved_ = -1;
    }
    return captured;
  }

 private:
  std::FILE* stream_;
  std::FILE* file_;
  int saved_ = -1;
};

class CaptureStderr : public CapturedStream {
 public:
  CaptureStderr() : CapturedStream(stderr) {}
};

class CaptureStdout : public CapturedStream {
 public:
  CaptureStdout() : CapturedStream(stdout) {}
};

}  // namespace sidestep
