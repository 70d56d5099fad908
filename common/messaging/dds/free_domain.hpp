// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// Reserves a DDS domain that no process on this machine uses. No other object of this class on this machine
/// gets the same domain during its lifetime; a file lock ensures that.
class FreeDomain {
 public:
  /// Throws std::runtime_error if all domains are in use, or with the reason if a lock file cannot be made.
  FreeDomain();
  ~FreeDomain();
  FreeDomain(const FreeDomain&) = delete;
  FreeDomain& operator=(const FreeDomain&) = delete;

  int number() const { return number_; }

 private:
  int number_ = 0, lock_ = -1;
};

}  // namespace sidestep
