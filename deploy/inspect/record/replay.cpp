// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/replay.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>

namespace sidestep {
namespace {

/// The topics that agents, coordinators, robots and operators write.
constexpr std::array kCommanding = {std::string_view(topics::kCommand.name),
                                    std::string_view(topics::kFeedback.name),
                                    std::string_view(topics::kRegistration.name),
                                    std::string_view(topics::kProposal.name),
                                    std::string_view(topics::kVerdict.name),
                                    std::string_view(topics::kLedger.name),
                                    std::string_view(topics::kCoordinator.name),
                                    std::string_view(topics::kAttestation.name),
                                    std::string_view(topics::kOrder.name),
                                    std::string_view(topics::kOrderMemory.name),
                                    std::string_view(topics::kAgentOrders.name),
                                    std::string_view(topics::kCourse.name),
                                    std::string_view(topics::kCourseOffer.name),
                                    std::string_view(topics::kSharedCourse.name),
                                    std::string_view(topics::kSharedCourseOffer.name),
                                    std::string_view(topics::kDisturbance.name),
                                    std::string_view(topics::kNetworkFault.name)};

}  // namespace

bool is_commanding(const TopicInfo& topic) {
  return std::ranges::find(kCommanding, std::string_view(topic.name)) != kCommanding.end();
}

std::optional<std::string> reason_against_replay(const std::vector<DiscoveredEndpoint>& others) {
  for (const DiscoveredEndpoint& other : others) {
    const std::string topic = other.topic.substr(0, other.topic.rfind('/'));
    if (other.is_writer && std::ranges::find(kCommanding, topic) != kCommanding.end())
      return fmt::format("{} writes {} in this domain",
                         other.participant.empty() ? other.guid : other.participant, other.topic);
  }
  return std::nullopt;
}

}  // namespace sidestep
