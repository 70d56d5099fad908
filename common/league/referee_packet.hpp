// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/geometry/vec2.hpp"
#include "common/league/decode_error.hpp"
#include "common/time/time.hpp"

namespace sidestep::league {

/// The referee's commands, with their numbers on the wire.
enum class RefereeCommand : std::uint8_t {
  kHalt,
  kStop,
  kNormalStart,
  kForceStart,
  kPrepareKickoffYellow,
  kPrepareKickoffBlue,
  kPreparePenaltyYellow,
  kPreparePenaltyBlue,
  kDirectFreeYellow,
  kDirectFreeBlue,
  kIndirectFreeYellow,  ///< occurs only in logs of earlier years, like kGoalYellow and kGoalBlue
  kIndirectFreeBlue,
  kTimeoutYellow,
  kTimeoutBlue,
  kGoalYellow,
  kGoalBlue,
  kBallPlacementYellow,
  kBallPlacementBlue
};
inline constexpr std::size_t kRefereeCommands = 18;

/// The league's name of a command, e.g. "FORCE_START".
std::string_view name_of(RefereeCommand command);

/// The team that a command concerns; nullopt if it concerns both teams.
std::optional<Team> team_of(RefereeCommand command);

/// The part of the Referee message that navigation needs.
struct RefereePacket {
  Duration sent{0};  ///< send time by the sender's clock, like DetectionFrame::captured
  RefereeCommand command = RefereeCommand::kHalt;
  std::uint32_t command_counter = 0;               ///< number of commands since the referee's start
  Duration commanded{0};                           ///< time of the command, by the sender's clock
  std::optional<Vec2> designated_position_m = {};  ///< target position of ball placement
};

/// Encodes the payload of a datagram; the names of the teams are empty. Precondition: the numbers are finite
/// and in the ranges that decode_referee() accepts.
std::vector<std::byte> encode(const RefereePacket& packet);

/// Rejects a packet as a whole if its command is unknown, a coordinate beyond kMaxCoordinate_m, or a time
/// beyond 2^33 s.
Decoded<RefereePacket> decode_referee(std::span<const std::byte> bytes);

}  // namespace sidestep::league
