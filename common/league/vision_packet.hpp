// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/league/field_geometry.hpp"
#include "common/league/refusal.hpp"
#include "common/time/time.hpp"

namespace sidestep::league {

struct SeenBall {
  Vec2 position_m{0, 0};
  std::optional<double> height_m;
  double confidence = 0;  ///< 0 .. 1
  Vec2 pixel{0, 0};
  std::optional<std::uint32_t> area;  ///< in pixels
};

struct SeenRobot {
  std::optional<std::uint32_t> number;  ///< below kMaxNumbers; none: nobody could tell
  Vec2 position_m{0, 0};
  std::optional<double> heading_rad;  ///< in [-pi, pi] when decoded
  double confidence = 0;              ///< 0 .. 1
  Vec2 pixel{0, 0};
  std::optional<double> height_m;  ///< of its top
};

/// What one camera saw at one instant. Times count by the sender's clock, whose zero is anywhere: 1970 for
/// some, the beginning of a simulation for others.
struct Detection {
  std::uint32_t frame_number = 0;
  std::uint32_t camera = 0;
  Duration captured{0};
  Duration sent{0};
  std::optional<Duration> captured_by_camera;  ///< by yet another clock
  std::vector<SeenBall> balls;
  std::vector<SeenRobot> yellow;
  std::vector<SeenRobot> blue;
};

/// SSL_WrapperPacket: one detection, or the geometry, or both.
struct VisionPacket {
  std::optional<Detection> detection;
  std::optional<Geometry> geometry;
  std::optional<std::uint32_t> source;  ///< the program that sends, as the league numbers them
};

/// The bytes of a datagram. Precondition: numbers are finite and in the ranges that decode_vision() accepts.
std::vector<std::byte> encode(const VisionPacket& packet);

/// Refuses a packet as a whole when anything in it makes no sense: places beyond 100 m, headings beyond 7
/// rad, confidences outside 0..1, times outside 0 .. 2^33 s, more than 64 robots of a team, numbers out of
/// range.
Decoded<VisionPacket> decode_vision(std::span<const std::byte> bytes);

}  // namespace sidestep::league
