// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/league/decode_error.hpp"
#include "common/league/field_geometry.hpp"
#include "common/time/time.hpp"

namespace sidestep::league {

struct DetectedBall {
  Vec2 position_m{0, 0};
  std::optional<double> height_m;
  double confidence = 0;  ///< 0 .. 1
  Vec2 pixel{0, 0};
  std::optional<std::uint32_t> area;  ///< area in pixels
};

struct DetectedRobot {
  std::optional<std::uint32_t> number;  ///< below kRobotNumbers; nullopt: not identified
  Vec2 position_m{0, 0};
  std::optional<double> heading_rad;  ///< in [-pi, pi] when decoded
  double confidence = 0;              ///< 0 .. 1
  Vec2 pixel{0, 0};
  std::optional<double> height_m;  ///< height of the robot's top
};

/// SSL_DetectionFrame: the detections in one image. Times are by the sender's clock, whose epoch is
/// arbitrary: for some senders 1970, for others the start of a simulation.
struct DetectionFrame {
  std::uint32_t frame_number = 0;
  std::uint32_t camera = 0;
  Duration captured{0};
  Duration sent{0};
  std::optional<Duration> captured_by_camera;  ///< capture time by the camera's own clock
  std::vector<DetectedBall> balls;
  std::vector<DetectedRobot> yellow;
  std::vector<DetectedRobot> blue;
};

/// SSL_WrapperPacket: a detection frame, the geometry, or both.
struct VisionPacket {
  std::optional<DetectionFrame> detection;
  std::optional<Geometry> geometry;
  std::optional<std::uint32_t> source;  ///< the sending program, as a number defined by the league
};

/// Encodes the payload of a datagram. Precondition: the numbers are finite and in the ranges that
/// decode_vision() accepts.
std::vector<std::byte> encode(const VisionPacket& packet);

/// Rejects a packet as a whole if any value in it is invalid: coordinates beyond kMaxCoordinate_m, headings
/// beyond 7 rad, confidences outside 0 .. 1, times outside -3600 .. 2^33 s, more than 64 robots of a team,
/// ids out of range.
Decoded<VisionPacket> decode_vision(std::span<const std::byte> bytes);

}  // namespace sidestep::league
