// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// The kinds of processes, which determine what a process may read and write.
enum class Role : std::uint8_t {
  kAgent,
  kCoordinator,
  kVision,
  kSimulator,
  kRobot,  ///< drives third-party robots
  kReferee,
  kClient,    ///< gives orders
  kOperator,  ///< gives orders that take precedence, causes faults, and attests absences
  kViewer,    ///< reads everything but the ground truth, and writes nothing
  kJudge      ///< reads everything, and writes nothing
};

/// A set of roles.
class Roles {
 public:
  constexpr Roles() = default;
  constexpr Roles(Role role) : bits_(static_cast<std::uint16_t>(1U << static_cast<unsigned>(role))) {}

  constexpr bool has(Role role) const { return overlaps(role); }
  constexpr bool overlaps(Roles other) const { return (bits_ & other.bits_) != 0; }
  friend constexpr Roles operator|(Roles a, Roles b) {
    a.bits_ |= b.bits_;
    return a;
  }

 private:
  std::uint16_t bits_ = 0;
};

constexpr Roles operator|(Role a, Role b) { return Roles(a) | Roles(b); }

/// Roles that watch a run.
inline constexpr Roles kWatchers = Role::kOperator | Role::kViewer | Role::kJudge;
/// Roles whose processes have their own clocks and rules.
inline constexpr Roles kSystemRoles =
    Role::kAgent | Role::kCoordinator | Role::kVision | Role::kSimulator | Role::kRobot | Role::kReferee;

/// Roles with only one process per number.
inline constexpr Roles kSingleInstanceRoles =
    Role::kCoordinator | Role::kVision | Role::kSimulator | Role::kReferee;

}  // namespace sidestep
