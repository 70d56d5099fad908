// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/messaging/topics.hpp"
#include "deploy/inspect/floor/floor_state.hpp"
#include "deploy/view/server/web_server.hpp"

namespace sidestep {

/// Serves the Foxglove WebSocket protocol (github.com/foxglove/ws-protocol, docs/spec.md, version 1), so that
/// Lichtblick and Foxglove show a run live. Each topic is a channel, with the CDR bytes of the messages and
/// the IDL of their type; topics with one DDS channel per robot are one channel here. For 3-D panels there
/// are also foxglove.SceneUpdate and foxglove.FrameTransforms, in JSON. Clients cannot write.
///
/// A client that reads slowly gets only the newest message of each sender.
class FoxgloveServer {
 public:
  /// The protocol's names; a client must understand at least one.
  static const std::vector<std::string>& protocols();

  FoxgloveServer();

  void add(WebSocket& socket);
  void remove(WebSocket& socket) { clients_.erase(&socket); }
  /// Processes a message from a client. False: the message is invalid.
  [[nodiscard]] bool on_message(WebSocket& socket, const std::string& message);

  /// Sends a message of a topic to its subscribers.
  void publish(const AnyMessage& message, Time now);
  /// Sends the robots and obstacles to the subscribers of scene or transforms.
  void publish_scene(const FloorState& floor, double radius_m, Time now);

 private:
  using ChannelId = std::uint32_t;
  struct Client {
    std::map<std::uint32_t, ChannelId> subscriptions;  // indexed by the client's ids
  };

  [[nodiscard]] bool subscribe(Client& client, const nlohmann::json& subscriptions);
  bool is_subscribed(ChannelId channel) const;
  /// Sends a message. Slow clients get only the newest one of several with the same channel and `key`.
  void send(ChannelId channel, std::uint32_t key, Time now, const std::string& payload);

  std::map<std::string, ChannelId> channels_;  // indexed by topic; 0 is not used
  std::map<WebSocket*, Client> clients_;
};

}  // namespace sidestep
