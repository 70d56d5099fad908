// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace sidestep::league {

/// Why a datagram is not a valid packet.
enum class DecodeError : std::uint8_t {
  kNone,
  kTooLong,    ///< longer than a UDP datagram
  kMalformed,  ///< not a message of this type, or a required field is missing
  kEmpty,      ///< no content
  kTooMany,    ///< too many elements of one kind
  kNumber,     ///< a number that is not finite or out of range
  kCamera,     ///< a camera id out of range
  kRobot,      ///< a robot id or team out of range
  kTime,       ///< a time that is not finite or out of range
  kText,       ///< a text that is too long
  kCommand     ///< an unknown referee command
};
inline constexpr std::size_t kDecodeErrors = 11;

/// A description for messages, e.g. "a camera id is out of range".
std::string_view describe(DecodeError error);

/// A packet, or the reason for its rejection.
template <typename Packet>
struct [[nodiscard]] Decoded {
  std::optional<Packet> packet;
  DecodeError error = DecodeError::kNone;
};

/// The maximum payload of a UDP datagram over IPv4.
inline constexpr std::size_t kMaxDatagramSize = 65507;
/// Cameras are numbered 0 .. kMaxCameras - 1.
inline constexpr std::uint32_t kMaxCameras = 64;
/// Robots of a team are numbered 0 .. kRobotNumbers - 1; there is one standard marker pattern per number.
inline constexpr std::uint32_t kRobotNumbers = 16;

}  // namespace sidestep::league
