// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/handshake_check.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "common/messaging/dds/number_reader.hpp"

namespace sidestep {
namespace {

struct KnownProperty {
  std::string_view name;
  std::size_t min_size, max_size;
};

constexpr std::size_t kMaxDocument = 65'000, kHash = 32, kMaxNumber = 1024, kMaxName = 64;
constexpr std::string_view kParticipantData = "c.pdata";
constexpr std::array<KnownProperty, 13> kProperties{{{"c.id", 1, kMaxDocument},
                                                     {"c.perm", 1, kMaxDocument},
                                                     {kParticipantData, 4, kMaxDocument},
                                                     {"c.dsign_algo", 1, kMaxName},
                                                     {"c.kagree_algo", 1, kMaxName},
                                                     {"ocsp_status", 0, kMaxDocument},
                                                     {"hash_c1", kHash, kHash},
                                                     {"hash_c2", kHash, kHash},
                                                     {"challenge1", kHash, kHash},
                                                     {"challenge2", kHash, kHash},
                                                     {"dh1", 1, kMaxNumber},
                                                     {"dh2", 1, kMaxNumber},
                                                     {"signature", 1, kMaxNumber}}};
constexpr std::array<std::string_view, 3> kTokens{"DDS:Auth:PKI-DH:1.0+Req", "DDS:Auth:PKI-DH:1.0+Reply",
                                                  "DDS:Auth:PKI-DH:1.0+Final"};

/// A text without its terminating zero; empty if it has none.
std::string_view read_terminated_text(NumberReader& reader) {
  const auto bytes = reader.counted_bytes();
  if (bytes.empty() || bytes.back() != 0) return {};
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size() - 1};
}

/// Whether the bytes are a list of parameters in network order.
bool is_participant_data(std::span<const std::uint8_t> bytes) {
  NumberReader reader(bytes, false);
  reader.skip_parameters();
  return reader.is_at_end();
}

bool take_property(NumberReader& reader) {
  const std::string_view name = read_terminated_text(reader);
  const auto value = reader.counted_bytes();
  const auto known = std::ranges::find(kProperties, name, &KnownProperty::name);
  return reader.is_valid() && known != kProperties.end() && value.size() >= known->min_size &&
         value.size() <= known->max_size && (name != kParticipantData || is_participant_data(value));
}

}  // namespace

bool is_handshake_message(std::span<const std::uint8_t> payload) {
  constexpr std::size_t kEncapsulationSize = 4;
  // The identities of this message and of the message that it answers, followed by three GUIDs.
  constexpr std::size_t kHeadSize = 2 * (16 + 8) + 3 * 16;
  if (payload.size() < kEncapsulationSize || payload[0] != 0 || payload[1] > 1) return false;
  NumberReader reader(payload.subspan(kEncapsulationSize), payload[1] == 1);
  reader.take(kHeadSize);
  if (read_terminated_text(reader) != "dds.sec.auth" || reader.number(4) != 1) return false;
  if (std::ranges::find(kTokens, read_terminated_text(reader)) == kTokens.end()) return false;
  if (reader.number(4) != 0) return false;  // number of properties with text values
  const std::uint32_t count = reader.number(4);
  if (count == 0 || count > kProperties.size()) return false;
  for (std::uint32_t i = 0; i < count; ++i)
    if (!take_property(reader)) return false;
  return reader.is_at_end();
}

}  // namespace sidestep
