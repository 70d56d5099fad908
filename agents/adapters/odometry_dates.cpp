// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/odometry_dates.hpp"

namespace sidestep {

bool OdometryDates::admit(Time measured_at, Time arrived_at) {
  const Duration age = arrived_at - measured_at;
  if (age < -max_error_) {
    proven_at_.reset();
    return false;
  }
  if (age <= max_error_) proven_at_ = arrived_at;
  return proven_at_ && arrived_at - *proven_at_ <= kBeliefPeriod && age <= kMaxLateness * max_error_;
}

}  // namespace sidestep
