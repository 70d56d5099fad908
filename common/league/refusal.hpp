// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace sidestep::league {

/// Why bytes from the network are no packet that anybody should believe.
enum class Refusal : std::uint8_t {
  kNone,
  kTooLong,    ///< longer than a datagram can be
  kMalformed,  ///< not of the message's type, or without a field that it must have
  kEmpty,      ///< says nothing
  kTooMany,    ///< more elements of one kind than make sense
  kNumber,     ///< not finite, or out of range
  kCamera,     ///< a camera's number out of range
  kRobot,      ///< a robot's number or team out of range
  kTime,       ///< a time that is not finite or out of range
  kText        ///< a text that is too long
};
inline constexpr std::size_t kRefusals = 10;

/// For people, as in "refused: a camera's number is out of range".
std::string_view in_words(Refusal refusal);

/// A packet, or why there is none.
template <typename Packet>
struct Decoded {
  std::optional<Packet> packet;
  Refusal refusal = Refusal::kNone;
};

/// The most that a UDP datagram carries over IPv4.
inline constexpr std::size_t kLongestDatagram = 65507;
/// Cameras are numbered 0 .. kMaxCameras - 1.
inline constexpr std::uint32_t kMaxCameras = 64;
/// Robots of a team are numbered 0 .. kMaxNumbers - 1: so many patterns there are.
inline constexpr std::uint32_t kMaxNumbers = 16;

}  // namespace sidestep::league
