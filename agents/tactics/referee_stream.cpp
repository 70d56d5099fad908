// SPDX-License-Identifier: Apache-2.0
#include "agents/tactics/referee_stream.hpp"

namespace sidestep {

RefereeStream::Outcome RefereeStream::add(const league::RefereePacket& packet, const league::Endpoint& from,
                                          Time now) {
  const bool was_silent = !referee_ || now - in_order_at_ > kSilence;
  if (!was_silent && from != *referee_) return Outcome::kForeign;
  if (was_silent || packet.sent >= newest_sent_) {
    referee_ = from;
    newest_sent_ = packet.sent;
    in_order_at_ = now;
    return Outcome::kAccepted;
  }
  return packet.command == league::RefereeCommand::kHalt ? Outcome::kAccepted : Outcome::kLate;
}

}  // namespace sidestep
