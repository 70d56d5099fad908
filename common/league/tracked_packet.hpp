// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/geometry/vec2.hpp"
#include "common/geometry/vec3.hpp"
#include "common/league/decode_error.hpp"
#include "common/time/time.hpp"

namespace sidestep::league {

struct TrackedBall {
  Vec3 position_m{0, 0, 0};
  std::optional<Vec3> velocity_mps;
  std::optional<double> visibility;  ///< 0 .. 1
};

struct TrackedRobot {
  std::optional<Team> team;  ///< nullopt: unknown
  std::uint32_t number = 0;
  Vec2 position_m{0, 0};
  double heading_rad = 0;  ///< in [-pi, pi] when decoded
  std::optional<Vec2> velocity_mps;
  std::optional<double> angular_radps;
  std::optional<double> visibility;  ///< 0 .. 1
};

struct TrackedFrame {
  std::uint32_t frame_number = 0;
  Duration at{0};  ///< time by the sender's clock, like DetectionFrame::captured
  std::vector<TrackedBall> balls;
  std::vector<TrackedRobot> robots;
};

/// TrackerWrapperPacket without the optional kicked ball and capabilities.
struct TrackedPacket {
  std::string uuid;  ///< identifies the sending process; a restarted process has a new one
  std::optional<std::string> source_name;
  std::optional<TrackedFrame> frame;
};

/// Encodes the payload of a datagram. Precondition: the numbers are finite and in the ranges that
/// decode_tracked() accepts.
std::vector<std::byte> encode(const TrackedPacket& packet);

/// Rejects a packet as a whole if any value in it is invalid: coordinates beyond kMaxCoordinate_m, headings
/// beyond 7 rad, speeds beyond 100 m/s or 1000 rad/s, visibilities outside 0 .. 1, times outside 0 .. 2^33 s.
Decoded<TrackedPacket> decode_tracked(std::span<const std::byte> bytes);

}  // namespace sidestep::league
