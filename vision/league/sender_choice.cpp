// SPDX-License-Identifier: Apache-2.0
#include "vision/league/sender_choice.hpp"

#include <algorithm>

namespace sidestep {

bool SenderChoice::is_allowed(const league::Endpoint& sender) const {
  return std::ranges::any_of(allowed_, [&](const league::Endpoint& allowed) {
    return allowed.address == sender.address && (allowed.port == 0 || allowed.port == sender.port);
  });
}

bool SenderChoice::admit(const league::Endpoint& sender, Time now) {
  // A clock that was set back must not keep a silent sender in use.
  const bool is_free = !used_ || now - used_at_ > kMaxSilence || now < used_at_;
  const bool is_used = allowed_.empty() ? is_free || *used_ == sender : is_allowed(sender);
  if (!is_used) {
    refused_ = sender;
    ++refused_packets_;
    return false;
  }
  used_ = sender;
  used_at_ = now;
  return true;
}

league::Endpoint parse_sender(const std::string& text) {
  if (text.find(':') != std::string::npos) return league::parse_unicast_endpoint(text);
  return {league::parse_address(text), 0};
}

}  // namespace sidestep
