// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/robot_notices.hpp"
#include "coordinator/coordinator.hpp"
#include "tests/catch.hpp"
#include "tests/unit/coordinator/floor.hpp"

namespace sidestep::coordinator_test {

inline constexpr Epoch kEpoch = 100;
inline constexpr Time kNow = time_from_ns(1'000'000'000'000);

/// A coordinator of two robots at rest, 1 m apart.
struct Floor {
  Coordinator coordinator{floor_for_tests(), {1, 2}, kEpoch};
  Version a = rest_version(1, {0, 0}), b = rest_version(2, {1, 0});

  // Messages are decoded as in CoordinatorNode.
  std::optional<Verdict> receive(const msg::Proposal& message) {
    const auto proposal = decode(message, kNow);
    return proposal ? coordinator.on_proposal(*proposal) : std::nullopt;
  }
  std::optional<Verdict> receive(const msg::Registration& message) {
    const auto registration = decode(message, kNow);
    return registration ? coordinator.on_registration(*registration) : std::nullopt;
  }
  void receive(const msg::Feedback& message) {
    if (const auto robot_report = decode(message, message.robot(), kNow))
      coordinator.on_robot_report(*robot_report, robot_report->valid_at);
  }
  void register_both() {
    receive(registration_of(a, kEpoch));
    receive(registration_of(b, kEpoch));
    REQUIRE(coordinator.is_granting());
  }
  Verdict ask(const msg::Proposal& proposal) {
    const auto verdict = receive(proposal);
    REQUIRE(verdict);
    return *verdict;
  }
};

inline std::vector<RobotId> missing(const Coordinator& coordinator) {
  return missing_robots(coordinator.state());
}

}  // namespace sidestep::coordinator_test
