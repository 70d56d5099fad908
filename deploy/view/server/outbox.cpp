// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/outbox.hpp"

#include <utility>

namespace sidestep {

bool Outbox::add_event(WebMessage message) {
  event_bytes_ += message.payload->size();
  events_.push_back(std::move(message));
  return event_bytes_ <= kMaxEventBytes;
}

std::optional<WebMessage> Outbox::take() {
  if (!events_.empty()) {
    WebMessage message = std::move(events_.front());
    events_.pop_front();
    event_bytes_ -= message.payload->size();
    return message;
  }
  if (states_.empty()) return std::nullopt;
  auto next = states_.upper_bound(last_slot_);
  if (next == states_.end()) next = states_.begin();
  last_slot_ = next->first;
  WebMessage message = std::move(next->second);
  states_.erase(next);
  return message;
}

}  // namespace sidestep
