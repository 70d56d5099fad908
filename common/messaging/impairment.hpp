// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

#include "common/messaging/impaired_link.hpp"
#include "idl/disturbance.h"

namespace sidestep {

/// Messages arrive as they come.
inline constexpr LinkQuality kUntouchedLink{0, 1, 0, Duration{0}, Duration{0}, Duration{0}, false};

/// What an order of `sidestep fault network` asks for; nothing when it makes no sense.
std::optional<LinkQuality> link_quality_from(const msg::NetworkFault& order);

/// What happens to the messages that come to one process, by sender. From any thread.
class Impairment {
 public:
  using SenderId = std::array<std::uint8_t, 12>;

  void set(const LinkQuality& quality, std::uint64_t seed);
  Copies receive(const SenderId& sender);

 private:
  std::mutex mutex_;
  LinkQuality quality_ = kUntouchedLink;
  Rng rng_{0};
  std::map<SenderId, ImpairedLink> links_;
};

}  // namespace sidestep
