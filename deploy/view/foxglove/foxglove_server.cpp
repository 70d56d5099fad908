// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/foxglove/foxglove_server.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "common/messaging/message_schema.hpp"
#include "deploy/inspect/floor/foxglove_scene.hpp"
#include "deploy/view/server/viewer_json.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxSubscriptions = 1000;
constexpr std::uint8_t kMessageData = 1;

template <typename Number>
void append(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i)
    bytes += static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * i) & 0xff);
}

Json json_channel(std::uint32_t id, const std::string& topic, const std::string& type) {
  return {{"id", id},           {"topic", topic},        {"encoding", "json"},
          {"schemaName", type}, {"schema", kJsonSchema}, {"schemaEncoding", "jsonschema"}};
}

std::optional<std::uint32_t> id_in(const Json& json, const char* key) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  if (found == json.end() || !found->is_number_unsigned() || found->get<std::uint64_t>() > 0xffffffffu)
    return std::nullopt;
  return found->get<std::uint32_t>();
}

WebMessage text_message(const Json& json) {
  // A text that a viewer has sent may contain invalid UTF-8.
  return {std::make_shared<const std::string>(json_text(json)), false};
}

}  // namespace

const std::vector<std::string>& FoxgloveServer::protocols() {
  static const std::vector<std::string> names{"foxglove.websocket.v1", "foxglove.sdk.v1"};
  return names;
}

FoxgloveServer::FoxgloveServer() {
  for (const TopicInfo& topic : all_topics())
    if (topic.qos != Qos::kImage) channels_[topic.name] = static_cast<ChannelId>(channels_.size() + 1);
  for (const char* topic : {kSceneTopic, kTransformsTopic})
    channels_[topic] = static_cast<ChannelId>(channels_.size() + 1);
}

void FoxgloveServer::add(WebSocket& socket) {
  clients_[&socket];
  socket.send_event(text_message({{"op", "serverInfo"},
                                  {"name", "sidestep"},
                                  {"capabilities", Json::array()},
                                  {"supportedEncodings", Json::array()},
                                  {"metadata", Json::object()}}));
  Json channels = Json::array();
  for (const TopicInfo& topic : all_topics()) {
    const auto channel = channels_.find(topic.name);
    if (channel == channels_.end()) continue;
    channels.push_back({{"id", channel->second},
                        {"topic", topic.name},
                        {"encoding", "cdr"},
                        {"schemaName", topic.type.name},
                        {"schema", message_schema(topic.type.name)},
                        {"schemaEncoding", "omgidl"}});
  }
  channels.push_back(json_channel(channels_.at(kSceneTopic), kSceneTopic, kSceneType));
  channels.push_back(json_channel(channels_.at(kTransformsTopic), kTransformsTopic, kTransformsType));
  socket.send_event(text_message({{"op", "advertise"}, {"channels", channels}}));
}

bool FoxgloveServer::subscribe(Client& client, const Json& subscriptions) {
  if (!subscriptions.is_array()) return false;
  for (const Json& subscription : subscriptions) {
    const auto id = id_in(subscription, "id"), channel = id_in(subscription, "channelId");
    if (!id || !channel || *channel == 0 || *channel > channels_.size()) return false;
    if (client.subscriptions.size() >= kMaxSubscriptions) return false;
    client.subscriptions[*id] = *channel;
  }
  return true;
}

bool FoxgloveServer::on_message(WebSocket& socket, const std::string& message) {
  const Json json = parse_viewer_json(message);
  const auto client = clients_.find(&socket);
  if (!json.is_object() || client == clients_.end()) return false;
  const Json op = json.value("op", Json());
  if (op == "subscribe") return subscribe(client->second, json.value("subscriptions", Json()));
  if (op == "unsubscribe") {
    const Json ids = json.value("subscriptionIds", Json());
    if (!ids.is_array()) return false;
    for (const Json& id : ids)
      if (id.is_number_unsigned())
        std::erase_if(client->second.subscriptions, [&](const auto& known) { return id == known.first; });
    return true;
  }
  if (!op.is_string()) return false;
  constexpr int kWarning = 1;
  socket.send_event(text_message(
      {{"op", "status"},
       {"level", kWarning},
       {"message", "this server only publishes; not supported: " + op.get<std::string>().substr(0, 100)}}));
  return true;
}

bool FoxgloveServer::is_subscribed(ChannelId channel) const {
  return std::ranges::any_of(clients_, [&](const auto& client) {
    return std::ranges::any_of(client.second.subscriptions,
                               [&](const auto& subscription) { return subscription.second == channel; });
  });
}

void FoxgloveServer::send(ChannelId channel, std::uint32_t key, Time now, const std::string& payload) {
  for (auto& [socket, client] : clients_) {
    for (const auto& [id, subscribed] : client.subscriptions) {
      if (subscribed != channel) continue;
      std::string bytes;
      bytes.reserve(payload.size() + 13);
      append(bytes, kMessageData);
      append(bytes, id);
      append(bytes, static_cast<std::uint64_t>(to_ns(now)));
      bytes += payload;
      constexpr std::uint32_t kKeys = 1u << 20;
      socket->send_state(channel * kKeys + key % kKeys,
                         {std::make_shared<const std::string>(std::move(bytes)), true});
    }
  }
}

void FoxgloveServer::publish(const AnyMessage& message, Time now) {
  if (clients_.empty()) return;
  const auto channel = channels_.find(message.topic.name);
  if (channel == channels_.end() || !is_subscribed(channel->second)) return;
  std::vector<std::uint8_t> cdr{0, 1, 0, 0};  // "CDR, little-endian"
  append_cdr(message.topic, message.message, cdr);
  const std::uint32_t key = message.topic.per_robot ? message.channel : message.header.sender();
  send(channel->second, key, now, {cdr.begin(), cdr.end()});
}

void FoxgloveServer::publish_scene(const FloorState& floor, double radius_m, Time now) {
  if (clients_.empty()) return;
  const ChannelId scene = channels_.at(kSceneTopic), transforms = channels_.at(kTransformsTopic);
  if (is_subscribed(scene)) send(scene, 0, now, json_text(scene_update(floor, radius_m, now)));
  if (is_subscribed(transforms)) send(transforms, 0, now, json_text(frame_transforms(floor, now)));
}

}  // namespace sidestep
