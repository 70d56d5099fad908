// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/sent_messages.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <utility>

#include "agents/agent/obstacle_list_decoder.hpp"
#include "agents/agent/received_page.hpp"
#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/observation_codec.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/version_codec.hpp"
#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

bool is_well_formed(const msg::Proposal& message, Time now) {
  const auto proposal = decode(message, now);
  const auto has_value = [](const auto& candidate) { return candidate.has_value(); };
  return proposal && proposal->candidate_count == message.candidate_count() &&
         std::all_of(proposal->candidates.begin(),
                     proposal->candidates.begin() + static_cast<std::ptrdiff_t>(proposal->candidate_count),
                     has_value);
}

bool is_well_formed(const msg::LedgerPage& message, Time now) {
  const auto decodes = [now](const msg::Version& version) { return decode(version, now).has_value(); };
  return ReceivedPage::decode(message, now) && std::ranges::all_of(message.versions(), decodes);
}

bool is_well_formed(const msg::WorldState& message, Time now) {
  const auto decodes = [now](const msg::TrackedRobot& robot) { return decode(robot, now).has_value(); };
  return std::ranges::all_of(message.robots(), decodes);
}

template <typename Message>
bool decodes(const Message& message, Time now) {
  return decode(message, now).has_value();
}

}  // namespace

template <typename Message>
std::function<void(const Message&)> SentMessages::counted(
    const Topic<Message>& topic, std::function<bool(const Message&)> is_well_formed) {
  const std::string name = topic.name;
  return [this, name, is_well_formed = std::move(is_well_formed)](const Message& message) {
    if (is_well_formed(message)) return;
    Count& count = malformed_[fmt::format("{} on {}", process_name(message.header().sender()), name)];
    if (count.messages++ == 0) count.first_at = bus_.now();
  };
}

SentMessages::SentMessages(Bus& bus, const Scenario& scenario) : bus_(bus), begin_(bus.now()) {
  const auto check = [this]<typename Message>(const Topic<Message>& topic, auto is_right) {
    bus_.subscribe(topic, counted<Message>(topic, [this, is_right](const Message& message) {
                     return is_right(message, bus_.now());
                   }));
  };
  check(topics::kRegistration, decodes<msg::Registration>);
  check(topics::kProposal, [](const msg::Proposal& m, Time now) { return is_well_formed(m, now); });
  check(topics::kLedger, [](const msg::LedgerPage& m, Time now) { return is_well_formed(m, now); });
  check(topics::kCoordinator, decodes<msg::CoordinatorState>);
  check(topics::kWorld, [](const msg::WorldState& m, Time now) { return is_well_formed(m, now); });
  check(topics::kOrderMemory, decodes<msg::OrderMemory>);
  check(topics::kAgentOrders, decodes<msg::OrderMemory>);
  check(topics::kOrderStatus, [](const msg::OrderStatus& m, Time) { return decode(m).has_value(); });
  check(topics::kObstacles, [decoder = std::make_shared<ObstacleListDecoder>()](
                                const msg::ObstacleList& m, Time) { return decoder->decode(m).has_value(); });
  for (const RobotSpec& spec : scenario.robots) {
    const RobotId robot = spec.id;
    bus_.subscribe(topics::kFeedback, robot,
                   counted<msg::Feedback>(topics::kFeedback, [this, robot](const msg::Feedback& message) {
                     return decode(message, robot, bus_.now()).has_value();
                   }));
    bus_.subscribe(topics::kCommand, robot,
                   counted<msg::Command>(topics::kCommand, [this, robot](const msg::Command& message) {
                     return decode(message, robot, bus_.now()).has_value();
                   }));
    bus_.subscribe(topics::kVerdict, robot,
                   counted<msg::Verdict>(topics::kVerdict, [robot](const msg::Verdict& message) {
                     return decode(message, robot).has_value();
                   }));
  }
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
