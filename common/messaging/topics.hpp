// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/messaging/cdr.hpp"
#include "common/protocol/roles.hpp"
#include "idl/clock.hpp"
#include "idl/course.hpp"
#include "idl/disturbance.hpp"
#include "idl/laser.hpp"
#include "idl/monitor.hpp"
#include "idl/negotiation.hpp"
#include "idl/order.hpp"
#include "idl/robot.hpp"
#include "idl/rules.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// Quality of service. States are best effort and keep the last sample of each key: each message of the
/// control cycle supersedes the previous one, and the protocol tolerates loss, so a retransmission would only
/// cost time. Events are few and should arrive: they are reliable, and in order per key (README.md lists when
/// they may still be lost). Images are states of about a megabyte that may be sent through shared memory.
enum class Qos : std::uint8_t { kState, kEvent, kImage };

/// A type-erased message type, for buses and recordings. Pointers to messages point to messages of this type.
struct MessageType {
  const char* name;          ///< the IDL name, for example sidestep::msg::Proposal
  std::size_t max_elements;  ///< bound of the sequence that is the type's last member; 0: no sequence
  std::shared_ptr<void> (*make)();
  std::shared_ptr<const void> (*copy)(const void* message);
  /// See the templates of the same names in cdr.hpp.
  std::size_t (*cdr_size)(const void* message);
  std::size_t (*write_cdr)(const void* message, std::span<std::uint8_t> bytes);
  CdrKey (*cdr_key)(const void* message);  ///< null: the type has no key
  /// Returns the message's Header.sender; null if the type has no header.
  std::uint32_t (*sender)(const void* message);
  bool (*read_cdr)(std::span<const std::uint8_t> bytes, ByteOrder order, std::size_t max_elements,
                   void* message);
};

/// A row of the topic table.
struct TopicInfo {
  const char* name = nullptr;
  Roles writers, readers;
  Qos qos{};
  bool per_robot = false;   ///< the topic has one channel per robot, "<name>/<robot>"
  bool is_checked = false;  ///< messages on this topic from processes with different rules are refused
  MessageType type{};
  bool is_single_writer =
      false;  ///< only one process at a time may write each channel, see SingleWriterGuard
};

template <typename Message>
struct Topic : TopicInfo {};

template <typename Message>
constexpr MessageType message_type(const char* name, std::size_t max_elements = 0) {
  std::uint32_t (*sender)(const void*) = nullptr;
  if constexpr (requires(const Message& m) { m.header().sender(); }) sender = message_sender<Message>;
  return {name,
          max_elements,
          make_message<Message>,
          copy_message<Message>,
          cdr_size<Message>,
          write_cdr<Message>,
          cdr_key<Message>,
          sender,
          read_cdr<Message>};
}

/// The DDS topic name: the topic's name, followed by the robot's number for topics with one channel per
/// robot.
inline std::string channel_name(const TopicInfo& topic, std::uint32_t robot) {
  return topic.per_robot ? std::string(topic.name) + "/" + std::to_string(robot) : topic.name;
}

/// For a per-robot topic, the robot in the channel name "<name>/<robot>"; for any other topic 0. nullopt if
/// the channel does not belong to the topic.
[[nodiscard]] std::optional<std::uint32_t> channel_robot(const TopicInfo& topic, const std::string& channel);

/// Appends the message's CDR bytes, little-endian, without an encapsulation header.
void append_cdr(const TopicInfo& topic, const void* message, std::vector<std::uint8_t>& bytes);
/// Decodes untrusted bytes as written by append_cdr() and passes the message to `use`. False if the bytes are
/// not a valid message of the topic.
[[nodiscard]] bool read_cdr(const TopicInfo& topic, std::span<const std::uint8_t> bytes,
                            const std::function<void(const void* message)>& use);

/// The topic table.
namespace topics {

inline constexpr Topic<msg::CameraImage> kImages{
    {"images", Role::kSimulator, Role::kVision | kWatchers, Qos::kImage, false, true,
     message_type<msg::CameraImage>("sidestep::msg::CameraImage", msg::MAX_IMAGE_BYTES), true}};
inline constexpr Topic<msg::DetectionFrame> kDetections{
    {"detections", Role::kSimulator, Role::kVision | kWatchers, Qos::kState, false, true,
     message_type<msg::DetectionFrame>("sidestep::msg::DetectionFrame", 1024), true}};
inline constexpr Topic<msg::WorldState> kWorld{
    {"world", Role::kVision, Role::kAgent | Role::kCoordinator | Role::kReferee | Role::kClient | kWatchers,
     Qos::kState, false, true, message_type<msg::WorldState>("sidestep::msg::WorldState", 1024)}};
inline constexpr Topic<msg::ObstacleList> kObstacles{
    {"obstacles", Role::kVision, Role::kAgent | kWatchers, Qos::kState, false, true,
     message_type<msg::ObstacleList>("sidestep::msg::ObstacleList", msg::MAX_OBSTACLES)}};
inline constexpr Topic<msg::Command> kCommand{{"command", Role::kAgent,
                                               Role::kSimulator | Role::kRobot | kWatchers, Qos::kState, true,
                                               true, message_type<msg::Command>("sidestep::msg::Command")}};
inline constexpr Topic<msg::Feedback> kFeedback{
    {"feedback", Role::kSimulator | Role::kRobot, Role::kAgent | Role::kCoordinator | kWatchers, Qos::kState,
     true, true, message_type<msg::Feedback>("sidestep::msg::Feedback"), true}};
inline constexpr Topic<msg::LaserScan> kScan{
    {"scan", Role::kSimulator | Role::kRobot, Role::kAgent | kWatchers, Qos::kState, true, true,
     message_type<msg::LaserScan>("sidestep::msg::LaserScan", msg::MAX_BEAMS), true}};
inline constexpr Topic<msg::Registration> kRegistration{
    {"registration", Role::kAgent, Role::kCoordinator | kWatchers, Qos::kState, false, true,
     message_type<msg::Registration>("sidestep::msg::Registration")}};
inline constexpr Topic<msg::Proposal> kProposal{{"proposal", Role::kAgent, Role::kCoordinator | kWatchers,
                                                 Qos::kState, false, true,
                                                 message_type<msg::Proposal>("sidestep::msg::Proposal")}};
inline constexpr Topic<msg::Verdict> kVerdict{{"verdict", Role::kCoordinator, Role::kAgent | kWatchers,
                                               Qos::kState, true, true,
                                               message_type<msg::Verdict>("sidestep::msg::Verdict")}};
inline constexpr Topic<msg::LedgerPage> kLedger{
    {"ledger", Role::kCoordinator, Role::kAgent | kWatchers, Qos::kState, false, true,
     message_type<msg::LedgerPage>("sidestep::msg::LedgerPage", 256)}};
inline constexpr Topic<msg::CoordinatorState> kCoordinator{
    {"coordinator", Role::kCoordinator, kSystemRoles | Role::kClient | kWatchers, Qos::kState, false, true,
     message_type<msg::CoordinatorState>("sidestep::msg::CoordinatorState", 1024)}};
inline constexpr Topic<msg::AbsenceAttestation> kAttestation{
    {"attestation", Role::kOperator, Role::kCoordinator | kWatchers, Qos::kEvent, false, false,
     message_type<msg::AbsenceAttestation>("sidestep::msg::AbsenceAttestation")}};
inline constexpr Topic<msg::Order> kOrder{
    {"order", Role::kClient | Role::kReferee | Role::kOperator, Role::kCoordinator | kWatchers, Qos::kEvent,
     false, false, message_type<msg::Order>("sidestep::msg::Order", msg::MAX_ORDER_POSES)}};
inline constexpr Topic<msg::OrderAnswer> kOrderAnswer{
    {"order_answer", Role::kCoordinator, Role::kClient | Role::kReferee | kWatchers, Qos::kEvent, false,
     false, message_type<msg::OrderAnswer>("sidestep::msg::OrderAnswer")}};
inline constexpr Topic<msg::OrderMemory> kOrderMemory{
    {"order_memory", Role::kCoordinator,
     Role::kCoordinator | Role::kAgent | Role::kClient | Role::kReferee | kWatchers, Qos::kEvent, false, true,
     message_type<msg::OrderMemory>("sidestep::msg::OrderMemory", msg::MAX_MEMORY_POSES)}};
/// Separate from the coordinators' topic, so that agents, which ignore each other's memories, need not
/// discover each other's endpoints.
inline constexpr Topic<msg::OrderMemory> kAgentOrders{
    {"agent_orders", Role::kAgent, Role::kCoordinator | kWatchers, Qos::kEvent, false, true,
     message_type<msg::OrderMemory>("sidestep::msg::OrderMemory", msg::MAX_MEMORY_POSES)}};
inline constexpr Topic<msg::OrderStatus> kOrderStatus{
    {"order_status", Role::kAgent, Role::kCoordinator | Role::kClient | Role::kReferee | kWatchers,
     Qos::kState, false, true, message_type<msg::OrderStatus>("sidestep::msg::OrderStatus")}};
inline constexpr Topic<msg::Course> kCourse{
    {"course", Role::kAgent, Role::kCoordinator | kWatchers, Qos::kState, false, true,
     message_type<msg::Course>("sidestep::msg::Course", msg::MAX_COURSE_POINTS)}};
inline constexpr Topic<msg::CourseOffer> kCourseOffer{
    {"course_offer", Role::kAgent, Role::kCoordinator | kWatchers, Qos::kState, false, true,
     message_type<msg::CourseOffer>("sidestep::msg::CourseOffer", msg::MAX_COURSE_POINTS)}};
/// Courses and offers that the active coordinator has relayed, so that agents need not discover each other's
/// endpoints.
inline constexpr Topic<msg::Course> kSharedCourse{
    {"shared_course", Role::kCoordinator, Role::kAgent | kWatchers, Qos::kState, false, true,
     message_type<msg::Course>("sidestep::msg::Course", msg::MAX_COURSE_POINTS)}};
inline constexpr Topic<msg::CourseOffer> kSharedCourseOffer{
    {"shared_course_offer", Role::kCoordinator, Role::kAgent | kWatchers, Qos::kState, false, true,
     message_type<msg::CourseOffer>("sidestep::msg::CourseOffer", msg::MAX_COURSE_POINTS)}};
inline constexpr Topic<msg::AgentStatus> kStatus{
    {"status", Role::kAgent, kWatchers, Qos::kState, false, true,
     message_type<msg::AgentStatus>("sidestep::msg::AgentStatus")}};
/// Counts of messages that each process has refused, dropped or received too late. Processes that must be the
/// only one with their id also use it to detect a second process.
inline constexpr Topic<msg::Counters> kCounters{
    {"counters", kSystemRoles, kSingleInstanceRoles | kWatchers, Qos::kState, false, true,
     message_type<msg::Counters>("sidestep::msg::Counters", msg::MAX_COUNTERS)}};
inline constexpr Topic<msg::Disturbance> kDisturbance{
    {"disturbance", Role::kOperator, Role::kAgent | Role::kSimulator | Role::kRobot | kWatchers, Qos::kEvent,
     false, false, message_type<msg::Disturbance>("sidestep::msg::Disturbance")}};
inline constexpr Topic<msg::DisturbanceAnswer> kDisturbanceAnswer{
    {"disturbance_answer", Role::kSimulator, kWatchers, Qos::kEvent, false, false,
     message_type<msg::DisturbanceAnswer>("sidestep::msg::DisturbanceAnswer")}};
inline constexpr Topic<msg::NetworkFault> kNetworkFault{
    {"network_fault", Role::kOperator, kSystemRoles | kWatchers, Qos::kEvent, false, false,
     message_type<msg::NetworkFault>("sidestep::msg::NetworkFault")}};
inline constexpr Topic<msg::ClockProbe> kClockProbe{
    {"clock_probe", Role::kOperator, kSystemRoles | kWatchers, Qos::kState, false, false,
     message_type<msg::ClockProbe>("sidestep::msg::ClockProbe")}};
inline constexpr Topic<msg::ClockReading> kClockReading{
    {"clock_reading", kSystemRoles, kWatchers, Qos::kState, false, false,
     message_type<msg::ClockReading>("sidestep::msg::ClockReading", msg::MAX_PLACE)}};
/// Only for audit and metrics.
inline constexpr Topic<msg::GroundTruth> kTruth{
    {"truth", Role::kSimulator, Role::kJudge, Qos::kState, false, true,
     message_type<msg::GroundTruth>("sidestep::msg::GroundTruth", 1024), true}};

/// Sent by every process that has received messages from a process with different rules.
inline constexpr Topic<msg::SharedRules> kRules{
    {"rules", kSystemRoles | Role::kOperator, kSystemRoles | Role::kClient | kWatchers, Qos::kEvent, false,
     false, message_type<msg::SharedRules>("sidestep::msg::SharedRules", msg::MAX_RULES_TEXT)}};

}  // namespace topics

/// Calls `visit` with each Topic<Message> of the table.
template <typename Visitor>
void for_each_topic(Visitor visit) {
  visit(topics::kImages);
  visit(topics::kDetections);
  visit(topics::kWorld);
  visit(topics::kObstacles);
  visit(topics::kCommand);
  visit(topics::kFeedback);
  visit(topics::kScan);
  visit(topics::kRegistration);
  visit(topics::kProposal);
  visit(topics::kVerdict);
  visit(topics::kLedger);
  visit(topics::kCoordinator);
  visit(topics::kStatus);
  visit(topics::kAttestation);
  visit(topics::kOrder);
  visit(topics::kOrderAnswer);
  visit(topics::kOrderMemory);
  visit(topics::kAgentOrders);
  visit(topics::kOrderStatus);
  visit(topics::kCourse);
  visit(topics::kCourseOffer);
  visit(topics::kSharedCourse);
  visit(topics::kSharedCourseOffer);
  visit(topics::kDisturbance);
  visit(topics::kDisturbanceAnswer);
  visit(topics::kNetworkFault);
  visit(topics::kTruth);
  visit(topics::kRules);
  visit(topics::kCounters);
  visit(topics::kClockProbe);
  visit(topics::kClockReading);
}

/// All rows of the table.
std::vector<TopicInfo> all_topics();

}  // namespace sidestep
