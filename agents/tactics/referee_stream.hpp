// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/league/multicast.hpp"
#include "common/league/referee_packet.hpp"

namespace sidestep {

/// Selects the packets to use: the packets of one referee, in the order in which they were sent. HALT counts
/// even if it arrives late. After kSilence without a packet in order, any packet counts: the referee was
/// restarted, its clock was set back, or another referee has taken over.
class RefereeStream {
 public:
  enum class Outcome {
    kAccepted,
    kLate,    ///< sent before the last accepted packet
    kForeign  ///< from another sender, while the first sender is still sending
  };

  Outcome add(const league::RefereePacket& packet, const league::Endpoint& from, Time now);
  /// The sender whose packets are used; nullopt if none has been heard.
  const std::optional<league::Endpoint>& referee() const { return referee_; }

  /// A referee sends at least ten packets a second.
  static constexpr Duration kSilence{500'000'000};

 private:
  std::optional<league::Endpoint> referee_;
  Duration newest_sent_{0};
  Time in_order_at_{};  ///< arrival of the last packet in order
};

}  // namespace sidestep
