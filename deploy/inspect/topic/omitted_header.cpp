// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/omitted_header.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/messaging/topics.hpp"

namespace sidestep {
namespace {

bool has_our_header(const IdlType& type) {
  return std::ranges::any_of(type.members, [](const IdlMember& member) {
    return member.name == "header" && member.type->name == "sidestep::msg::Header";
  });
}

bool has_sender(const nlohmann::ordered_json& message) {
  const auto header = message.find("header");
  return header != message.end() && (!header->is_object() || header->contains("sender"));
}

}  // namespace

std::string sender_problem(const IdlType& type, const nlohmann::ordered_json& message,
                           const std::string& channel) {
  if (!has_our_header(type) || !message.is_object() || has_sender(message)) return "";
  for (const TopicInfo& topic : all_topics())
    if (channel_robot(topic, channel) && !topic.writers.has(Role::kOperator))
      return fmt::format(
          "header.sender: is missing, and processes refuse an operator's messages on '{}'; name a process "
          "that may send them (common/protocol/senders.hpp)",
          channel);
  return "";
}

nlohmann::ordered_json with_header(const IdlType& type, nlohmann::ordered_json message,
                                   const msg::Header& header) {
  if (!has_our_header(type) || !message.is_object()) return message;
  if (!message.contains("header")) message["header"] = nlohmann::ordered_json::object();
  nlohmann::ordered_json& given = message["header"];
  if (!given.is_object()) return message;
  const auto add = [&given](const char* name, const auto& value) {
    if (!given.contains(name)) given[name] = value;
  };
  add("sender", header.sender());
  add("incarnation", header.incarnation());
  add("message_number", header.message_number());
  add("stamp_ns", header.stamp_ns());
  return message;
}

}  // namespace sidestep
