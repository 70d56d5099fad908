// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace sidestep {

/// A message of a web socket, shared by all viewers that get it.
struct WebMessage {
  std::shared_ptr<const std::string> payload;
  bool is_binary = false;
};

/// The messages still to be sent to one viewer. For each state only the newest value is kept, so a slow
/// viewer gets fewer updates, and the memory stays bounded. Events are kept in order.
class Outbox {
 public:
  static constexpr std::size_t kMaxEventBytes = 4 << 20;

  /// `slot` identifies the state, for example the floor.
  void put_state(unsigned slot, WebMessage message) { states_[slot] = std::move(message); }
  /// Adds an event. False if the viewer reads too slowly to keep all events; it must then be disconnected.
  [[nodiscard]] bool add_event(WebMessage message);
  /// Removes and returns the next message to send: events first, then the states in turn. nullopt if there is
  /// none.
  std::optional<WebMessage> take();

 private:
  std::deque<WebMessage> events_;
  std::size_t event_bytes_ = 0;
  std::map<unsigned, WebMessage> states_;
  unsigned last_slot_ = 0;
};

}  // namespace sidestep
