// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/topics.hpp"

namespace sidestep {

std::vector<TopicInfo> all_topics() {
  return {topics::kImages,       topics::kDetections,   topics::kWorld,    topics::kCommand,
          topics::kFeedback,     topics::kRegistration, topics::kProposal, topics::kVerdict,
          topics::kLedger,       topics::kCoordinator,  topics::kStatus,   topics::kDisturbance,
          topics::kNetworkFault, topics::kTruth};
}

}  // namespace sidestep
