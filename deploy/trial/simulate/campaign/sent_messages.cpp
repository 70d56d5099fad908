// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/sent_messages.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "agents/agent/obstacle_list_decoder.hpp"
#include "agents/agent/received_page.hpp"
#include "common/messaging/course_codec.hpp"
#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/observation_codec.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/version_codec.hpp"
#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

// These functions have the same parameters: the message, the robot of its channel, and the bus that delivers
// it.

template <typename Message>
bool is_well_formed(const Message& message, RobotId, Bus& bus) {
  return decode(message, bus.now()).has_value();
}

bool is_well_formed(const msg::Registration& message, RobotId, Bus& bus) {
  const auto registration = decode(message, bus.now());
  return registration && (registration->versions || registration->asks_for_orders);
}

bool is_well_formed(const msg::Proposal& message, RobotId, Bus& bus) {
  const auto proposal = decode(message, bus.now());
  const auto has_value = [](const auto& candidate) { return candidate.has_value(); };
  return proposal && proposal->candidate_count == message.candidate_count() &&
         std::all_of(proposal->candidates.begin(),
                     proposal->candidates.begin() + static_cast<std::ptrdiff_t>(proposal->candidate_count),
                     has_value);
}

bool is_well_formed(const msg::WorldState& message, RobotId, Bus& bus) {
  const auto decodes = [now = bus.now()](const msg::TrackedRobot& robot) {
    return decode(robot, now).has_value();
  };
  return std::ranges::all_of(message.robots(), decodes);
}

bool is_well_formed(const msg::OrderStatus& message, RobotId, Bus&) { return decode(message).has_value(); }

bool is_well_formed(const msg::ObstacleList& message, RobotId, Bus&) {
  return ObstacleListDecoder().decode(message).has_value();
}

bool is_well_formed(const msg::Feedback& message, RobotId robot, Bus& bus) {
  return decode(message, robot, bus.now()).has_value();
}

bool is_well_formed(const msg::Command& message, RobotId robot, Bus& bus) {
  return decode(message, robot, bus.now()).has_value();
}

bool is_well_formed(const msg::Verdict& message, RobotId robot, Bus&) {
  return decode(message, robot).has_value();
}

/// Decodes the page for its later readers, too.
bool is_well_formed(const msg::LedgerPage& message, RobotId, Bus& bus) {
  const auto page = ReceivedPage::decode(message, bus.now(), bus.attachment(&message));
  if (!page) return false;
  std::shared_ptr<DecodedLedgerPage> decoded;
  page->update(decoded);
  return std::ranges::all_of(decoded->entries, &DecodedLedgerPage::Entry::is_valid);
}

}  // namespace

SentMessages::SentMessages(Bus& bus, const Scenario& scenario) : bus_(bus), begin_(bus.now()) {
  check(topics::kRegistration);
  check(topics::kProposal);
  check(topics::kLedger);
  check(topics::kCoordinator);
  check(topics::kWorld);
  check(topics::kOrderMemory);
  check(topics::kAgentOrders);
  check(topics::kOrderStatus);
  check(topics::kCourse);
  check(topics::kCourseOffer);
  check(topics::kSharedCourse);
  check(topics::kSharedCourseOffer);
  check(topics::kObstacles);
  for (const RobotSpec& robot : scenario.robots) {
    check(topics::kFeedback, robot.id);
    check(topics::kCommand, robot.id);
    check(topics::kVerdict, robot.id);
  }
}

template <typename Message>
void SentMessages::check(const Topic<Message>& topic, RobotId robot) {
  bus_.subscribe(topic, robot, [this, name = topic.name, robot](const Message& message) {
    if (is_well_formed(message, robot, bus_)) return;
    Count& count = malformed_[fmt::format("{} on {}", process_name(message.header().sender()), name)];
    if (count.messages++ == 0) count.first_at = bus_.now();
  });
}

std::vector<std::string> SentMessages::failures() const {
  std::vector<std::string> failures;
  for (const auto& [source, count] : malformed_) {
    failures.push_back(fmt::format("{} malformed messages of {}, the first at {:.3f} s", count.messages,
                                   source, to_seconds(count.first_at - begin_)));
  }
  return failures;
}

}  // namespace sidestep
