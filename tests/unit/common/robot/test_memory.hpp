// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/robot/robot_side.hpp"

namespace sidestep::robot::test {

/// A memory that a test can read and make fail.
class TestMemory final : public StableMemory {
 public:
  [[nodiscard]] bool store(const DurableState& state) override {
    if (fails) return false;
    stored = state;
    ++writes;
    return true;
  }
  DurableState stored;
  bool fails = false;
  int writes = 0;
};

inline std::int64_t at_ms(std::int64_t ms) { return 1'700'000'000'000'000'000 + ms * 1'000'000; }

inline Command command(std::uint64_t incarnation, std::uint64_t epoch, const Version* version = nullptr) {
  return {incarnation, epoch, 0, version};
}

/// At rest at the origin.
inline Version rest_version(std::uint64_t number, std::uint64_t base, std::int64_t start_ms,
                            std::uint64_t incarnation = 100) {
  Version version;
  version.incarnation = incarnation;
  version.number = number;
  version.base = base;
  version.start_ns = at_ms(start_ms);
  return version;
}

}  // namespace sidestep::robot::test
