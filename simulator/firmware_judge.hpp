// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/motion/version.hpp"
#include "idl/robot.h"

namespace sidestep {

/// Watches one robot's firmware from outside and counts the rules that it breaks (safety-protocol.md, "Who
/// does what"). Shares no code with it: it sees commands arrive, versions begin, and facts go out.
class FirmwareJudge {
 public:
  explicit FirmwareJudge(const Version& at_creation) : executing_(at_creation) {}

  void command_arrived(const msg::Command& command, Time now);
  void switched(const Version& to);
  void reported(const msg::Feedback& fact);

  std::uint64_t violations() const { return violations_; }

  static constexpr double kPositionJump_m = 0.001;
  static constexpr double kVelocityJump_mps = 0.05;

 private:
  struct Arrival {
    VersionNumber number = 0;
    VersionNumber base = 0;
    Incarnation incarnation = 0;
    Time start{};
    bool operator==(const Arrival&) const = default;
  };
  bool came_in_time(const Arrival& wanted) const;
  void require(bool kept) { violations_ += kept ? 0 : 1; }

  Version executing_;
  Incarnation acknowledged_ = 0;  ///< highest that a fact has named
  Epoch acknowledged_epoch_ = 0;
  Time last_fact_ = Time::min();
  std::array<Arrival, 64> arrivals_{};  ///< ring, of versions that came before their start
  std::uint64_t arrival_count_ = 0;
  VersionNumber newest_ = 0;
  std::uint64_t violations_ = 0;
};

}  // namespace sidestep
