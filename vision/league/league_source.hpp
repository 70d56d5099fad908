// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/league/multicast.hpp"
#include "common/league/vision_packet.hpp"
#include "idl/vision.h"
#include "vision/league/sender_clock.hpp"

namespace sidestep {

/// Makes of the league's vision packets what our own cameras send. Robots go by team and number; who has
/// none, or one that no robot of the scenario has, is an obstacle with the radius of the league's robots.
/// Each sender has a clock of its own. What is malformed, hostile, doubled or cannot be dated is counted and
/// dropped.
class LeagueSource {
 public:
  struct Counts {
    std::uint64_t packets = 0;
    std::uint64_t frames = 0;                                ///< that take() has given
    std::array<std::uint64_t, league::kRefusals> refused{};  ///< packets, by league::Refusal
    std::uint64_t doubled = 0;                               ///< frames that had come before
    std::uint64_t undated = 0;     ///< frames that came too late, or that a clock that was set stamped
    std::uint64_t detections = 0;  ///< of frames, left out: balls or obstacles beyond what a frame holds, and
                                   ///< robots of the scenario without a heading
  };

  /// Throws std::invalid_argument when two robots of the scenario have one team and number.
  explicit LeagueSource(const Scenario& scenario);

  /// What a datagram says that came from there at that time, valid until the next call; nullptr for nothing.
  const msg::DetectionFrame* take(std::span<const std::byte> datagram, const league::Endpoint& from,
                                  Time now);

  const Counts& counts() const { return counts_; }
  std::uint64_t refused() const;
  /// Why the latest packet was refused; kNone when it was not.
  league::Refusal refusal() const { return refusal_; }
  /// Times that senders' clocks were found to have been set.
  std::uint64_t clock_jumps() const;
  /// The field of the latest geometry, of which nothing else is used.
  const std::optional<league::FieldSize>& field() const { return field_; }

 private:
  struct FrameKey {
    std::uint32_t camera = 0;
    std::uint32_t number = 0;
    Duration captured{-1};
    bool operator==(const FrameKey&) const = default;
  };
  struct Sender {
    league::Endpoint endpoint;
    Time heard{};
    SenderClock clock{};
    std::array<FrameKey, 64> recent{};  ///< a ring: half a second of two cameras
    std::size_t next_recent = 0;
  };

  Sender& sender(const league::Endpoint& endpoint, Time now);
  static bool is_doubled(Sender& sender, const league::Detection& detection);
  void fill(const league::Detection& detection, Time captured_at);
  void add(Team team, const league::SeenRobot& robot);
  void add_obstacle(const Vec2& position_m);
  void add_balls(std::span<const league::SeenBall> balls);

  std::array<std::array<std::optional<RobotId>, league::kMaxNumbers>, 2> ids_;  ///< by team and number
  std::vector<Sender> senders_;
  msg::DetectionFrame frame_;
  std::vector<const league::SeenBall*> by_confidence_;
  std::optional<league::FieldSize> field_;
  league::Refusal refusal_ = league::Refusal::kNone;
  Counts counts_;
};

}  // namespace sidestep
