// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/motion/limits.hpp"
#include "common/motion/safety_budget.hpp"
#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// Observes one robot's firmware from outside and counts the rules that it breaks (coordinator/PROTOCOL.md,
/// "Roles"). Shares no code with the firmware: the simulator tells it of received commands (except malformed
/// ones), started versions and reported facts. All times are by the robot's clock.
class FirmwareMonitor {
 public:
  explicit FirmwareMonitor(const Version& initial, double tracking_bound_m = SafetyBudget{}.tracking_bound_m,
                           double deceleration_mps2 = MotionLimits{}.deceleration_mps2)
      : executing_(initial), tracking_bound_m_(tracking_bound_m), deceleration_mps2_(deceleration_mps2) {}

  void command_arrived(const Command& command, Time now);
  void switched(const Version& to);
  /// The firmware starts an own stop.
  void started_own_stop(const Version& to);
  void reported(const RobotReport& robot_report);
  void lifted();
  void put_down();
  void rebooted() { expects_reboot_stop_ = true; }
  /// The robot's clock has gone back, so earlier times are meaningless.
  void clock_went_back();

  std::uint64_t violations() const { return violations_; }

  static constexpr double kMaxPositionJump_m = 0.001;
  static constexpr double kMaxVelocityJump_mps = 0.05;

 private:
  struct Arrival {
    VersionNumber number = 0;
    VersionNumber base = 0;
    Incarnation incarnation = 0;
    Time start{};
    bool operator==(const Arrival&) const = default;
  };
  bool arrived_in_time(const Arrival& wanted) const;
  bool is_own_stop(const Trajectory& stop) const;
  void check_rule(bool is_kept) { violations_ += is_kept ? 0 : 1; }

  Version executing_;
  bool is_own_ = false;  ///< executing an own stop
  bool is_lifted_ = false;
  bool expects_reboot_stop_ = false;  ///< the robot has rebooted and has yet to make its own stop
  bool expects_clock_stop_ =
      false;  ///< the robot's clock has gone back and the robot has yet to make its own stop
  VersionNumber highest_executed_ = 0;
  std::uint64_t highest_seen_ = 0;  ///< highest version number or incarnation received
  Incarnation acknowledged_ = 0;    ///< highest incarnation reported in a fact
  Epoch acknowledged_epoch_ = 0;
  Time last_report_ = Time::min();
  std::array<Arrival, 64> arrivals_{};  ///< ring buffer of versions that arrived before their start
  std::uint64_t arrival_count_ = 0;
  VersionNumber highest_arrived_ = 0;
  std::uint64_t violations_ = 0;
  double tracking_bound_m_;
  double deceleration_mps2_;
};

}  // namespace sidestep
