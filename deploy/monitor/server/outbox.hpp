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

/// What one viewer has yet to get. Of each state only the newest is kept, so a slow viewer gets fewer updates
/// and the memory stays bounded. Events are kept in order.
class Outbox {
 public:
  static constexpr std::size_t kMaxEventBytes = 4 << 20;

  /// `slot` names the state, e.g. the floor.
  void put_state(unsigned slot, WebMessage message) { states_[slot] = std::move(message); }
  /// False: the viewer reads too slowly, so that not all events can be kept; it has to be disconnected.
  [[nodiscard]] bool add_event(WebMessage message);
  /// The next message to send: events first, then the states in turn. nullopt: none.
  std::optional<WebMessage> take();

 private:
  std::deque<WebMessage> events_;
  std::size_t event_bytes_ = 0;
  std::map<unsigned, WebMessage> states_;
  unsigned last_slot_ = 0;
};

}  // namespace sidestep
