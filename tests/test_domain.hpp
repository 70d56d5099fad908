// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <stdexcept>
#include <string>
#include <sys/file.h>
#include <unistd.h>

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// A DDS domain that no other test on this machine uses during the lifetime of this object; guarded by a file
/// lock.
class TestDomain {
 public:
  TestDomain() {
    for (number_ = 10; number_ < 90; ++number_) {
      const std::string path = "/tmp/sidestep-test-domain-" + std::to_string(number_);
      lock_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
      if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
      if (lock_ >= 0) close(lock_);
    }
    throw std::runtime_error("no free DDS domain for this test");
  }
  ~TestDomain() { close(lock_); }
  TestDomain(const TestDomain&) = delete;
  TestDomain& operator=(const TestDomain&) = delete;

  int number() const { return number_; }
  DdsSettings settings(const std::string& participant = "test") const {
    return {number_, "127.0.0.1", participant};
  }

 private:
  int number_ = 0, lock_ = -1;
};

}  // namespace sidestep
