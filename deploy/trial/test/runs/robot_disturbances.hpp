// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/client/disturbance_client.hpp"
#include "deploy/trial/test/plan/planned_fault.hpp"

namespace sidestep {

/// Disturbs robots, and collects which disturbances the simulator has not applied.
class RobotDisturbances {
 public:
  /// See DisturbanceClient.
  RobotDisturbances(Bus& bus, RawWriter& writer) : client_(bus, writer) {}

  /// `planned`: the fault of the test that contains the disturbance.
  void begin(const RobotDisturbance& disturbance, const PlannedFault& planned);
  /// Disturbances that were refused or not answered. Call it at the end of the run: disturbances that still
  /// wait for an answer are given up, because they may never have been applied.
  const std::vector<FaultProblem>& problems();

 private:
  DisturbanceClient client_;
  std::vector<FaultProblem> problems_;
};

}  // namespace sidestep
