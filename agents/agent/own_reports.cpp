// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/own_reports.hpp"

#include <algorithm>

#include "agents/navigation/dead_reckoning.hpp"

namespace sidestep {

void OwnReports::on_robot_report(const RobotReport& robot_report) {
  estimate_ = robot_report.estimate;
  max_dead_reckoning_m_ = max_dead_reckoning_m(robot_report.uncertainty, drift_bound_m_);
  const VersionNumber stop = robot_report.is_off_reference ? robot_report.executing.number : 0;
  reference_losses_ += stop > last_own_stop_;
  has_moved_ |= robot_report.has_moved;
  last_own_stop_ = std::max(last_own_stop_, stop);
}

double OwnReports::dead_reckoning_m(const Vec2& from) const {
  return std::max(0.0, max_dead_reckoning_m_ - (from - estimate_.position_m).norm());
}

bool OwnReports::agrees_with(const Vec2& observed) const {
  return (observed - estimate_.position_m).norm() <= drift_bound_m_;
}

}  // namespace sidestep
