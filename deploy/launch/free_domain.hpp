// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <stdexcept>
#include <string>
#include <sys/file.h>
#include <unistd.h>

namespace sidestep {

/// A DDS domain that no other object of this class on this machine uses during its lifetime; guarded by a
/// file lock.
class FreeDomain {
 public:
  /// Throws std::runtime_error if all domains are in use.
  FreeDomain() {
    for (number_ = 10; number_ < 90; ++number_) {
      const std::string path = "/tmp/sidestep-test-domain-" + std::to_string(number_);
      lock_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
      if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
      if (lock_ >= 0) close(lock_);
    }
    throw std::runtime_error("no free DDS domain for this test");
  }
  ~FreeDomain() { close(lock_); }
  FreeDomain(const FreeDomain&) = delete;
  FreeDomain& operator=(const FreeDomain&) = delete;

  int number() const { return number_; }

 private:
  int number_ = 0, lock_ = -1;
};

}  // namespace sidestep
