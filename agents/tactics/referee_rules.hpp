// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/geometry/field.hpp"
#include "common/league/referee_packet.hpp"
#include "common/protocol/order.hpp"

namespace sidestep {

struct RefereeSettings {
  /// The team whose robots obey orders, if only one team's robots do; otherwise nullopt.
  std::optional<Team> team{};
  /// Whether to keep all robots, including goalkeepers, out of both defence areas.
  bool closes_defence_areas = false;
};

/// The ball as last seen.
struct BallState {
  Vec2 position_m{0, 0};
  Vec2 velocity_mps{0, 0};
};

/// The referee's demands on the robots.
struct RefereeDemands {
  bool holds = false;  ///< all robots must stop
  std::map<std::uint32_t, Zone> zones{};
};

/// The numbers of the referee's zones.
inline constexpr std::uint32_t kFloorZone = 1, kBallZone = 2, kBallPathZone = 3, kLeftAreaZone = 4,
                               kRightAreaZone = 5;
inline constexpr std::array kRefereeZones{kFloorZone, kBallZone, kBallPathZone, kLeftAreaZone,
                                          kRightAreaZone};
/// A zone is moved only if a corner of the demanded zone is farther away than this.
inline constexpr double kZoneTolerance_m = 0.02;

/// Determines what robots must do at a command, by the rules of the Small Size League. Zones apply to all
/// robots. A rule for one team is therefore enforced only if it concerns the team whose robots obey; see
/// README.md.
class RefereeRules {
 public:
  RefereeRules(const Field& field, const RefereeSettings& settings);

  /// `ball` is nullopt if the ball has never been seen.
  RefereeDemands demands(const league::RefereePacket& packet, const std::optional<BallState>& ball) const;

 private:
  bool keeps_off_ball(league::RefereeCommand command) const;
  Zone around_ball(std::vector<Vec2> corners_m) const;
  /// nullopt if neither the ball nor its designated place is known.
  std::optional<Zone> ball_zone(const league::RefereePacket& packet,
                                const std::optional<BallState>& ball) const;
  /// The zone along the ball's predicted path. Robots in it have time to leave. It is separate from the zone
  /// around the ball, so robots leave it without passing the ball. nullopt if the ball rests.
  std::optional<Zone> ball_path_zone(const BallState& ball) const;

  RefereeSettings settings_;
  Zone floor_;
  std::array<Zone, 2> areas_;
};

/// Whether one zone can replace the other: they are equal except that corners may be up to kZoneTolerance_m
/// apart.
bool are_close(const Zone& a, const Zone& b);

}  // namespace sidestep
