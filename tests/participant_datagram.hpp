// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/messaging/dds/presence.hpp"

namespace sidestep {

/// An RTPS datagram of this sender that announces a participant with this user data (RTPS 2.2, 9.4.5.3).
inline std::vector<std::uint8_t> participant_datagram(const ParticipantId& id,
                                                      const std::vector<std::uint8_t>& user_data) {
  std::vector<std::uint8_t> result{'R', 'T', 'P', 'S', 2, 2, 1, 15};
  const auto append = [&](const auto& bytes) { result.insert(result.end(), bytes.begin(), bytes.end()); };
  const auto append_16 = [&](std::size_t number) {
    result.push_back(static_cast<std::uint8_t>(number));
    result.push_back(static_cast<std::uint8_t>(number >> 8));
  };
  const std::size_t padded = (user_data.size() + 3) / 4 * 4;
  append(id);
  append(std::array<std::uint8_t, 2>{0x15, 5});
  const std::size_t body = result.size() + 2;
  append_16(0);  // the body's size, set below
  append(std::array<std::uint8_t, 20>{0, 0, 16, 0, 0, 1, 0, 0xc7, 0, 1, 0, 0xc2, 0, 0, 0, 0, 1, 0, 0, 0});
  append(std::array<std::uint8_t, 8>{0, 3, 0, 0, 0x15, 0, 4, 0});  // list; protocol version:
  append(std::array<std::uint8_t, 4>{2, 2, 0, 0});
  append(std::array<std::uint8_t, 4>{0x50, 0, 16, 0});  // GUID
  append(id);
  append(std::array<std::uint8_t, 4>{0, 0, 1, 0xc1});
  append_16(0x2c);
  append_16(4 + padded);
  append_16(user_data.size());
  append_16(0);
  append(user_data);
  result.resize(result.size() + padded - user_data.size());
  append(std::array<std::uint8_t, 4>{1, 0, 0, 0});
  const std::size_t size = result.size() - body;
  result[body - 2] = static_cast<std::uint8_t>(size);
  result[body - 1] = static_cast<std::uint8_t>(size >> 8);
  return result;
}

}  // namespace sidestep
