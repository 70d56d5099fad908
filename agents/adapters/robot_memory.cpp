// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/robot_memory.hpp"

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
#include <sys/file.h>
#include <unistd.h>

#include "common/file/folder.hpp"
#include "common/file/output_file.hpp"

namespace sidestep {
namespace {

constexpr const char* kFirstLine = "sidestep robot memory 1";

std::string to_text(const robot::DurableState& state) {
  return fmt::format("{}\nincarnation {}\nepoch {}\nnumber_bound {}\nhas_moved {}\nend\n", kFirstLine,
                     state.incarnation, state.epoch, state.number_bound, state.has_moved ? 1 : 0);
}

class MemoryReader {
 public:
  explicit MemoryReader(const std::string& path) : path_(path), file_(path) {}

  robot::DurableState read() {
    robot::DurableState state;
    expect(kFirstLine);
    state.incarnation = number("incarnation");
    state.epoch = number("epoch");
    state.number_bound = number("number_bound");
    state.has_moved = number("has_moved") != 0;
    expect("end");
    return state;
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    throw std::runtime_error(
        fmt::format("{}:{}: expected \"{}\", found \"{}\"; a robot that has forgotten which agent it "
                    "obeys must not drive",
                    path_, line_number_, expected, line_));
  }
  void next() {
    ++line_number_;
    line_.clear();
    std::getline(file_, line_);
  }
  void expect(const std::string& text) {
    next();
    if (line_ != text) fail(text);
  }
  std::uint64_t number(const std::string& key) {
    next();
    std::uint64_t value = 0;
    const std::string prefix = key + " ";
    const char* const end = line_.data() + line_.size();
    if (!line_.starts_with(prefix)) fail(prefix + "NUMBER");
    const auto [rest, error] = std::from_chars(line_.data() + prefix.size(), end, value);
    if (error != std::errc{} || rest != end) fail(prefix + "NUMBER");
    return value;
  }

  std::string path_, line_;
  std::ifstream file_;
  int line_number_ = 0;
};

/// False, with errno set, if writing failed.
bool write_and_sync(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return false;
  errno = ENOSPC;  // a part was written
  const bool is_written =
      write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) && fsync(file) == 0;
  const int error = errno;
  if (close(file) != 0) return false;
  errno = error;
  return is_written;
}

bool sync_folder(const std::string& path) {
  const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return false;
  const bool is_synced = fsync(folder) == 0;
  close(folder);
  return is_synced;
}

}  // namespace

MemoryLock::MemoryLock(const std::string& path)
    : file_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (file_ >= 0 && flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  if (file_ < 0) throw_unwritable(path, write_problem(path, error));
  close(file_);
  throw std::runtime_error(
      error == EWOULDBLOCK ? fmt::format("{}: cannot be locked; does another process drive this robot?", path)
                           : fmt::format("{}: cannot be locked: {}", path, std::strerror(error)));
}

MemoryLock::~MemoryLock() { close(file_); }

RobotMemory::RobotMemory(const std::string& folder, RobotId robot)
    : folder_(folder), path_(fmt::format("{}/robot-{}.memory", folder, robot)) {
  if (const std::string problem = try_create_folder(folder); !problem.empty())
    throw std::runtime_error(
        fmt::format("{}: cannot create this folder for the robots' memories: {}", folder, problem));
  std::error_code error;
  lock_.emplace(path_ + ".lock");
  if (std::filesystem::exists(path_, error))
    state_ = MemoryReader(path_).read();
  else if (error)
    throw std::runtime_error(fmt::format("{}: cannot read: {}", path_, error.message()));
}

bool RobotMemory::store(const robot::DurableState& state) {
  const std::string next = path_ + ".next";
  const bool is_stored = write_and_sync(next, to_text(state)) && rename(next.c_str(), path_.c_str()) == 0 &&
                         sync_folder(folder_);
  failure_ = is_stored ? "" : fmt::format("cannot write {}: {}", path_, write_problem(path_, errno));
  if (is_stored) state_ = state;
  return is_stored;
}

std::string default_memory_folder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  const std::string base = state && *state ? state : fmt::format("{}/.local/state", home ? home : "");
  return base + "/sidestep/robots";
}

}  // namespace sidestep
