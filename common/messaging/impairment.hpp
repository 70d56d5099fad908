// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

#include "common/messaging/impaired_link.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

/// A perfect link: no loss, no delay, no duplicates.
inline constexpr LinkQuality kUnimpairedLink{0, 1, 0, Duration{0}, Duration{0}, Duration{0}, false};

/// Decodes a network fault; nullopt if a value is out of range.
[[nodiscard]] std::optional<LinkQuality> link_quality_from(const msg::NetworkFault& fault);

/// Impairs the messages that arrive at one process, with one link per sender. Thread-safe.
class Impairment {
 public:
  /// An RTPS GUID prefix.
  using SenderId = std::array<std::uint8_t, 12>;

  void set(const LinkQuality& quality, std::uint64_t seed);
  MessageCopies receive(const SenderId& sender);

 private:
  std::mutex mutex_;
  LinkQuality quality_ = kUnimpairedLink;
  Rng rng_{0};
  std::map<SenderId, ImpairedLink> links_;
};

}  // namespace sidestep
