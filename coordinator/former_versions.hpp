// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/motion/version.hpp"

namespace sidestep {

/// The versions that a robot has stopped executing most recently, for comparison with observations that
/// arrive late. At 60 Hz they cover a quarter of a second.
class FormerVersions {
 public:
  struct Entry {
    Version version;
    Time left_at{};  ///< from this time on, the robot was certainly no longer executing it
  };

  void add(const Version& version, Time left_at) { entries_[count_++ % kCapacity] = {version, left_at}; }
  /// All entries, in no particular order.
  std::span<const Entry> entries() const {
    return {entries_.data(), count_ < kCapacity ? static_cast<std::size_t>(count_) : kCapacity};
  }

 private:
  static constexpr std::size_t kCapacity = 16;
  std::array<Entry, kCapacity> entries_;
  std::uint64_t count_ = 0;
};

}  // namespace sidestep
