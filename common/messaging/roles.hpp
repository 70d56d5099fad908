// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// The kinds of processes, as far as what they may read and write is concerned.
enum class Role : std::uint8_t {
  kAgent,
  kCoordinator,
  kVision,
  kSimulator,
  kRobot,  ///< drives robots of others
  kReferee,
  kClient,    ///< gives orders
  kOperator,  ///< gives orders that come first, causes faults, and attests absences
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

/// Those that watch a run.
inline constexpr Roles kWatchers = Role::kOperator | Role::kViewer | Role::kJudge;
/// Those that have clocks and rules of their own.
inline constexpr Roles kParts =
    Role::kAgent | Role::kCoordinator | Role::kVision | Role::kSimulator | Role::kRobot | Role::kReferee;

/// Those of which there is one of each number.
inline constexpr Roles kSoleRoles = Role::kCoordinator | Role::kVision | Role::kSimulator | Role::kReferee;

}  // namespace sidestep
