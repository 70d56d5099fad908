// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/motion/limits.hpp"
#include "common/motion/safety_budget.hpp"
#include "common/motion/version.hpp"
#include "idl/robot.h"

namespace sidestep {

/// Watches one robot's firmware from outside and counts the rules that it breaks (safety-protocol.md, "Who
/// does what"). Shares no code with it: it sees commands arrive, versions begin, and facts go out. All times
/// are by the robot's clock.
class FirmwareMonitor {
 public:
  explicit FirmwareMonitor(const Version& at_creation,
                         double tracking_bound_m = SafetyBudget{}.tracking_bound_m,
                         double deceleration_mps2 = MotionLimits{}.deceleration_mps2)
      : executing_(at_creation), tracking_bound_m_(tracking_bound_m), deceleration_mps2_(deceleration_mps2) {}

  void command_arrived(const msg::Command& command, Time now);
  void switched(const Version& to);
  /// It goes over to a stop of its own.
  void broke_off(const Version& to);
  void reported(const msg::Feedback& fact);
  /// What hands did to it.
  void lifted();
  void put_down();
  void rebooted() { may_have_forgotten_ = true; }

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
  bool is_own_stop(const Trajectory& stop) const;
  void require(bool kept) { violations_ += kept ? 0 : 1; }

  Version executing_;
  bool is_own_ = false;  ///< executing a stop that it made itself
  bool is_lifted_ = false;
  bool may_have_forgotten_ = false;  ///< rebooted, and not yet standing off its reference
  VersionNumber highest_executed_ = 0;
  std::uint64_t highest_seen_ = 0;  ///< of all numbers and incarnations that came
  Incarnation acknowledged_ = 0;    ///< highest that a fact has named
  Epoch acknowledged_epoch_ = 0;
  Time last_fact_ = Time::min();
  std::array<Arrival, 64> arrivals_{};  ///< ring, of versions that came before their start
  std::uint64_t arrival_count_ = 0;
  VersionNumber newest_ = 0;
  std::uint64_t violations_ = 0;
  double tracking_bound_m_;
  double deceleration_mps2_;
};

}  // namespace sidestep
