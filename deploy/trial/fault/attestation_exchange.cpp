// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/attestation_exchange.hpp"

namespace sidestep {

bool AttestationExchange::update(bool is_missing, Time now) {
  if (state_ != State::kPending) return false;
  if (was_missing_ && !is_missing) {
    state_ = State::kAccepted;
    return false;
  }
  was_missing_ = is_missing;
  if (now > begun_ + kTimeout) {
    state_ = State::kTimedOut;
    return false;
  }
  if (!is_missing || now < due_) return false;
  due_ = now + kRepeat;
  return true;
}

std::string AttestationExchange::reason() const {
  return was_missing_ ? "the coordinator still waits for the robot, because it receives the robot's reports"
                      : "the coordinator does not wait for the robot";
}

}  // namespace sidestep
