// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "deploy/fault/plan/fault_test.hpp"
#include "deploy/monitor/metrics/run_metrics.hpp"

namespace sidestep {

/// Decides when a run of a test is over: at the scenario's time limit, or as soon as all faults and deadlines
/// are past and the robots that are expected to arrive have done so. Without such an expectation these are
/// all robots, except those that are expected not to arrive.
class TestEnd {
 public:
  explicit TestEnd(const FaultTest& test);

  /// `at_s`: since the first grant; never decreases.
  [[nodiscard]] bool is_over(double at_s, const std::vector<RobotProgress>& progress);

 private:
  double decided_s_ = 0;  // all faults and deadlines are past
  double limit_s_;
  std::vector<RobotId> arriving_;
  std::optional<double> arrived_since_s_;
};

}  // namespace sidestep
