// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "deploy/audit/metrics/run_metrics.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"

namespace sidestep {

/// Decides when a run of a test is over: at the scenario's time limit, or as soon as all faults and deadlines
/// are past and all robots that are expected to arrive have arrived. Without an expectation about arrivals,
/// all robots are expected to arrive, except those that are expected not to arrive.
class TestEnd {
 public:
  explicit TestEnd(const FaultTest& test);

  /// Returns whether the test is over. `at_s` is the time since the first grant; it must never decrease.
  [[nodiscard]] bool update(double at_s, const std::vector<RobotProgress>& progress);

 private:
  double decided_s_ = 0;  // time at which all faults and deadlines are past
  double limit_s_;
  std::vector<RobotId> arriving_;
  std::optional<double> arrived_since_s_;
};

}  // namespace sidestep
