// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/odometry_timestamp_check.hpp"

namespace sidestep {

bool OdometryTimestampCheck::admit(Time measured_at, Time arrived_at) {
  const Duration age = arrived_at - measured_at;
  if (age < -max_error_) {
    trusted_at_.reset();
    return false;
  }
  if (age <= max_error_) trusted_at_ = arrived_at;
  return trusted_at_ && arrived_at - *trusted_at_ <= kTrustPeriod && age <= kMaxLateness * max_error_;
}

}  // namespace sidestep
