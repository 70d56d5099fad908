// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "idl/disturbance.h"
#include "idl/monitor.h"
#include "idl/negotiation.h"
#include "idl/robot.h"
#include "idl/vision.h"

namespace sidestep {

/// All topics are best effort and keep the last sample of each key: every message of the control cycle is
/// superseded by the next one, and the protocol is built for loss, so a late repetition would only cost time.
/// Events are few and must arrive: reliable, in order. Images are states of a megabyte, which may go by
/// shared memory.
enum class Qos : std::uint8_t { kState, kEvent, kImage };

/// What a bus has to know of a message type.
struct MessageType {
  const char* name;                                  ///< as in the IDL, e.g. sidestep::msg::Proposal
  std::size_t max_elements;                          ///< bound of the sequence at the type's end, 0: none
  std::shared_ptr<const void> (*copy)(const void*);  ///< a copy to keep
};

/// A row of the topic table.
struct TopicInfo {
  const char* name;
  const char* writer;  ///< who writes it
  Qos qos;
  bool per_robot;  ///< one channel for each robot, "<name>/<robot>", so that nobody has to listen to all
  MessageType type;
};

template <typename Message>
struct Topic : TopicInfo {};

template <typename Message>
constexpr MessageType message_type(const char* name, std::size_t max_elements = 0) {
  return {name, max_elements, [](const void* m) -> std::shared_ptr<const void> {
            return std::make_shared<const Message>(*static_cast<const Message*>(m));
          }};
}

/// The name on the wire: the topic's, with the robot's number for topics that every robot has one of.
inline std::string channel_name(const TopicInfo& topic, std::uint32_t robot) {
  return topic.per_robot ? std::string(topic.name) + "/" + std::to_string(robot) : topic.name;
}

/// The one table of topics.
namespace topics {

inline constexpr Topic<msg::CameraImage> kImages{
    {"images", "simulator", Qos::kImage, false,
     message_type<msg::CameraImage>("sidestep::msg::CameraImage", msg::MAX_IMAGE_BYTES)}};
inline constexpr Topic<msg::DetectionFrame> kDetections{
    {"detections", "simulator", Qos::kState, false,
     message_type<msg::DetectionFrame>("sidestep::msg::DetectionFrame", 1024)}};
inline constexpr Topic<msg::WorldState> kWorld{
    {"world", "vision", Qos::kState, false,
     message_type<msg::WorldState>("sidestep::msg::WorldState", 1024)}};
inline constexpr Topic<msg::Command> kCommand{
    {"command", "agent", Qos::kState, true, message_type<msg::Command>("sidestep::msg::Command")}};
inline constexpr Topic<msg::Feedback> kFeedback{
    {"feedback", "simulator", Qos::kState, true, message_type<msg::Feedback>("sidestep::msg::Feedback")}};
inline constexpr Topic<msg::Registration> kRegistration{
    {"registration", "agent", Qos::kState, false,
     message_type<msg::Registration>("sidestep::msg::Registration")}};
inline constexpr Topic<msg::Proposal> kProposal{
    {"proposal", "agent", Qos::kState, false, message_type<msg::Proposal>("sidestep::msg::Proposal")}};
inline constexpr Topic<msg::Verdict> kVerdict{
    {"verdict", "coordinator", Qos::kState, true, message_type<msg::Verdict>("sidestep::msg::Verdict")}};
inline constexpr Topic<msg::LedgerPage> kLedger{
    {"ledger", "coordinator", Qos::kState, false,
     message_type<msg::LedgerPage>("sidestep::msg::LedgerPage", 256)}};
inline constexpr Topic<msg::CoordinatorState> kCoordinator{
    {"coordinator", "coordinator", Qos::kState, false,
     message_type<msg::CoordinatorState>("sidestep::msg::CoordinatorState", 1024)}};
inline constexpr Topic<msg::AgentStatus> kStatus{
    {"status", "agent", Qos::kState, false, message_type<msg::AgentStatus>("sidestep::msg::AgentStatus")}};
inline constexpr Topic<msg::Disturbance> kDisturbance{
    {"disturbance", "fault", Qos::kEvent, false,
     message_type<msg::Disturbance>("sidestep::msg::Disturbance")}};
inline constexpr Topic<msg::NetworkFault> kNetworkFault{
    {"network_fault", "fault", Qos::kEvent, false,
     message_type<msg::NetworkFault>("sidestep::msg::NetworkFault")}};
/// For judges only.
inline constexpr Topic<msg::GroundTruth> kTruth{
    {"truth", "simulator", Qos::kState, false,
     message_type<msg::GroundTruth>("sidestep::msg::GroundTruth", 1024)}};

}  // namespace topics

/// Every row of the table, for tools that list, listen and check.
std::vector<TopicInfo> all_topics();

}  // namespace sidestep
