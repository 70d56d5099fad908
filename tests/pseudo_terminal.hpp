// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <pty.h>
#include <stdexcept>
#include <string>
#include <sys/ioctl.h>
#include <unistd.h>

namespace sidestep {

/// A terminal of which a test sees the output.
class PseudoTerminal {
 public:
  PseudoTerminal(int columns, int rows) {
    if (openpty(&master_, &slave_, nullptr, nullptr, nullptr) != 0)
      throw std::runtime_error("cannot open a pseudo terminal");
    for (const int end : {master_, slave_}) fcntl(end, F_SETFD, FD_CLOEXEC);
    stream_ = fdopen(fcntl(slave_, F_DUPFD_CLOEXEC, 0), "w");
    resize(columns, rows);
  }
  ~PseudoTerminal() {
    close_own_end();
    close(master_);
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  std::FILE* stream() const { return stream_; }
  /// The end for a program, which can be duplicated as its stdout.
  int slave() const { return slave_; }
  /// Leaves the other end to the processes that have duplicated it.
  void close_own_end() {
    if (slave_ < 0) return;
    std::fclose(stream_);
    close(slave_);
    slave_ = -1;
  }
  void resize(int columns, int rows) const {
    winsize size{};
    size.ws_col = static_cast<unsigned short>(columns);
    size.ws_row = static_cast<unsigned short>(rows);
    if (ioctl(master_, TIOCSWINSZ, &size) != 0) throw std::runtime_error("cannot resize the terminal");
  }
  /// All that has been written since the last call.
  std::string read_all() const {
    constexpr char kEnd = '\x06';
    if (write(slave_, &kEnd, 1) != 1) return "cannot write to the terminal";
    std::string bytes;
    while (!bytes.ends_with(kEnd) && read_some(bytes)) {
    }
    return bytes.substr(0, bytes.find(kEnd));
  }
  /// Appends what arrives next. False at the end, when no process has the other end open.
  bool read_some(std::string& bytes) const {
    std::array<char, 4096> buffer{};
    const ssize_t got = read(master_, buffer.data(), buffer.size());
    if (got > 0) bytes.append(buffer.data(), static_cast<std::size_t>(got));
    return got > 0;
  }

 private:
  int master_ = -1, slave_ = -1;
  std::FILE* stream_ = nullptr;
};

/// Sets an environment variable, or removes it, for the lifetime of the object.
class EnvironmentVariable {
 public:
  /// `value`: nullptr removes the variable.
  EnvironmentVariable(const char* name, const char* value) : name_(name) {
    if (const char* const former = std::getenv(name)) former_ = former, had_value_ = true;
    set(value);
  }
  ~EnvironmentVariable() { set(had_value_ ? former_.c_str() : nullptr); }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  void set(const char* value) const { value ? setenv(name_, value, 1) : unsetenv(name_); }
  const char* name_;
  std::string former_;
  bool had_value_ = false;
};

}  // namespace sidestep
