// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sched.h>
#include <stdexcept>
#include <string>
#include <sys/mount.h>

#include "common/file/temporary_folder.hpp"

namespace sidestep {

/// A file system in memory that only this process and its children see. Needs root.
class SmallDisk {
 public:
  explicit SmallDisk(std::size_t kibibytes = 1024) {
    static const bool has_own_mounts =
        unshare(CLONE_NEWNS) == 0 && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
    const std::string options = "mode=0755,size=" + std::to_string(kibibytes) + "k";
    if (!has_own_mounts || mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, options.c_str()) != 0)
      throw std::runtime_error("cannot mount a file system for the test");
  }
  ~SmallDisk() { umount2(folder_.path().c_str(), MNT_DETACH); }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  const std::string& path() const { return folder_.path(); }
  std::string file(const std::string& name) const { return folder_.file(name); }
  /// Leaves no room for a single byte.
  void fill() const {
    std::ofstream filling(file("filling"), std::ios::binary);
    while (filling << std::string(4096, ' ') << std::flush) {
    }
  }
  void make_read_only() const {
    if (mount(nullptr, path().c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) != 0)
      throw std::runtime_error("cannot make the file system read-only");
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace sidestep
