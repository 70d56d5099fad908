// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/geometry/circle.hpp"
#include "common/league/multicast.hpp"
#include "common/league/vision_packet.hpp"
#include "common/protocol/drop_counters.hpp"
#include "idl/vision.hpp"
#include "vision/league/sender_choice.hpp"
#include "vision/league/sender_clock.hpp"

namespace sidestep {

/// Converts the league's vision packets to detection frames. Robots are identified by team and number; a
/// robot without a number, or with a number that is not in the scenario, becomes an obstacle of a league
/// robot's radius. One sender is used, or those that are listed; each sender's clock is estimated separately.
/// Malformed, invalid and duplicate packets, and packets whose capture time cannot be determined, are counted
/// and dropped.
class LeagueSource {
 public:
  struct Counts {
    std::uint64_t packets = 0;
    std::uint64_t frames = 0;  ///< number of frames returned by decode()
    /// Number of packets, indexed by league::DecodeError.
    std::array<std::uint64_t, league::kDecodeErrors> rejected{};
    /// Number of frames dropped because they were received before.
    std::uint64_t duplicates = 0;
    /// Number of frames whose capture time could not be determined, or only with an uncertainty of more than
    /// SenderClock::kMaxUncertainty.
    std::uint64_t unsynchronised = 0;
    /// Number of detections dropped: balls and obstacles beyond the capacity of a frame (the obstacles
    /// nearest to robots are kept), and robots of the scenario without a heading.
    std::uint64_t dropped = 0;
  };

  /// `senders` are the only senders to use, as in SenderChoice. Throws std::invalid_argument if two robots of
  /// the scenario have the same team and number.
  explicit LeagueSource(const Scenario& scenario, std::vector<league::Endpoint> senders = {});

  /// The detections in a datagram that has just been received; nullptr if there are none. Valid until the
  /// next call.
  [[nodiscard]] const msg::DetectionFrame* decode(std::span<const std::byte> datagram,
                                                  const league::Endpoint& sender, Time now);

  /// Maximum error of the capture time of the frame that decode() returned last.
  Duration date_uncertainty() const { return date_uncertainty_; }
  /// The clock of the sender of the latest detections; nullptr before.
  const SenderClock* clock() const { return latest_ ? &senders_[*latest_].clock : nullptr; }
  /// That sender; nullopt before.
  std::optional<league::Endpoint> detecting_sender() const {
    return latest_ ? std::optional(senders_[*latest_].endpoint) : std::nullopt;
  }
  const SenderChoice& choice() const { return choice_; }
  const Counts& counts() const { return counts_; }
  void count_drops(DropCounters& drops) const;
  /// Number of packets rejected so far, for any reason.
  std::uint64_t rejected() const;
  /// The reason why the latest packet was rejected; kNone if it was accepted.
  league::DecodeError error() const { return error_; }
  /// Number of jumps detected in the senders' clocks.
  std::uint64_t clock_jumps() const;
  /// The field in the latest geometry packet; the rest of the packet is not used.
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
    Time last_received{};
    SenderClock clock{};
    std::array<FrameKey, 64> recent{};  ///< ring buffer for half a second of two cameras
    std::size_t next_recent = 0;
  };

  Sender& sender_at(const league::Endpoint& endpoint, Time now);
  static bool is_duplicate(Sender& sender, const league::DetectionFrame& detection);
  void fill_frame(const league::DetectionFrame& detection, Time captured_at);
  void add_robot(Team team, const league::DetectedRobot& robot);
  void add_balls(std::span<const league::DetectedBall> balls);

  /// Robot ids, indexed by team and number.
  std::array<std::array<std::optional<RobotId>, league::kRobotNumbers>, 2> ids_;
  SenderChoice choice_;
  std::vector<Sender> senders_;
  msg::DetectionFrame frame_;
  std::vector<Circle> obstacles_;  ///< obstacles in the frame that is being filled
  std::vector<const league::DetectedBall*> by_confidence_;
  std::optional<league::FieldSize> field_;
  std::optional<std::size_t> latest_;  ///< index of the sender of the latest detections
  Duration date_uncertainty_{0};
  league::DecodeError error_ = league::DecodeError::kNone;
  Counts counts_;
};

}  // namespace sidestep
