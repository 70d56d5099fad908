// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// A DDS domain that no process of this machine uses when the object is made, and no other object of this
/// class on this machine during its lifetime: guarded by a file lock.
class FreeDomain {
 public:
  /// Throws std::runtime_error if all domains are in use.
  FreeDomain();
  ~FreeDomain();
  FreeDomain(const FreeDomain&) = delete;
  FreeDomain& operator=(const FreeDomain&) = delete;

  int number() const { return number_; }

 private:
  int number_ = 0, lock_ = -1;
};

}  // namespace sidestep
