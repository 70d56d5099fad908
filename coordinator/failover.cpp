// SPDX-License-Identifier: Apache-2.0
#include "coordinator/failover.hpp"

#include <algorithm>

#include "common/messaging/senders.hpp"

namespace sidestep {
namespace {

// Added to the longest recent gap between heartbeats.
constexpr Duration kHeartbeatTimeout{100'000'000};
// Per coordinator number, so that standbys do not take over simultaneously.
constexpr Duration kTimeoutStagger{25'000'000};
// A standby that has just started may not have been discovered by the others yet.
constexpr Duration kStartTimeout{1'000'000'000};
constexpr Duration kStartTimeoutStagger{200'000'000};
// After a pause of this length, unprocessed heartbeats may be queued.
constexpr Duration kPauseThreshold{60'000'000};
constexpr int kMaxBackoffExponent = 2;
// Two instances with the same number that begin above one known epoch choose different epochs, because each
// adds its incarnation modulo this spread.
constexpr Epoch kEpochSpread = 1'000'003;

}  // namespace

Failover::Failover(const CoordinatorIdentity& self, bool is_standby, Time now)
    : self_(self), last_heartbeat_(now), last_update_(now), is_starting_(is_standby) {
  if (!is_standby) begin_epoch(now, {});
}

void Failover::begin_epoch(Time now, const RoleCause& cause) {
  cause_ = cause;
  const Epoch above = highest_ == 0 ? 0 : highest_ + 1 + self_.incarnation % kEpochSpread;
  const Epoch min_epoch =
      std::max<Epoch>({above, static_cast<Epoch>(std::max<std::int64_t>(to_ns(now), 0)), 1});
  // The epoch modulo kMaxCoordinators is the number, so different numbers never share an epoch.
  epoch_ = min_epoch + (kMaxCoordinators + self_.number - min_epoch % kMaxCoordinators) % kMaxCoordinators;
  highest_ = epoch_;
  is_starting_ = false;
}

void Failover::stand_by(Time now, const RoleCause& cause) {
  if (is_active()) {
    cause_ = cause;
    heard_.reset();
  }
  epoch_ = 0;
  last_heartbeat_ = now;
  has_heartbeat_ = false;
}

void Failover::record_heartbeat(Time now) {
  if (has_heartbeat_) gaps_[heartbeat_count_++ % gaps_.size()] = now - last_heartbeat_;
  has_heartbeat_ = true;
  last_heartbeat_ = now;
  is_starting_ = false;
  backoff_exponent_ = 0;
}

void Failover::on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now) {
  const auto own_sender = static_cast<std::uint32_t>(Sender::kCoordinator) + self_.number;
  const bool is_own = heartbeat.sender == own_sender && heartbeat.incarnation == self_.incarnation;
  if (is_own || heartbeat.epoch == 0 || heartbeat.mode == msg::CoordinatorMode::COORDINATOR_STANDBY) return;
  if (heartbeat.epoch < highest_) return;
  const CoordinatorNumber number = heartbeat.sender - static_cast<std::uint32_t>(Sender::kCoordinator);
  if (is_active() && heartbeat.epoch == epoch_) {
    const RoleCause shared{msg::RoleReason::ROLE_SHARED_EPOCH, number, Duration{0}, heartbeat.epoch};
    // Two instances with the same number share an epoch, so the grants of neither can be trusted.
    if (heartbeat.incarnation < self_.incarnation) return begin_epoch(now, shared);
    return stand_by(now, shared);
  }
  highest_ = heartbeat.epoch;
  if (is_active()) {
    stand_by(now, {msg::RoleReason::ROLE_EPOCH_OF_COORDINATOR, number, Duration{0}, heartbeat.epoch});
  } else {
    record_heartbeat(now);
  }
  heard_ = number;
}

void Failover::on_obeyed_epoch(Epoch epoch, bool is_granting, Time now, RobotId robot, EpochHolder holder) {
  if (epoch <= highest_) return;
  if (!is_plausible(epoch, now)) {
    ++invalid_;
    return;
  }
  if (!obeyed_epochs_.admit(now)) {
    ++too_frequent_;
    return;
  }
  highest_ = epoch;
  const RoleCause cause{holder == EpochHolder::kRobot ? msg::RoleReason::ROLE_EPOCH_OF_ROBOT
                                                      : msg::RoleReason::ROLE_EPOCH_OF_AGENT,
                        robot, Duration{0}, epoch};
  // A coordinator that is not granting yet begins a new epoch above the obeyed one. A granting one has been
  // superseded by one whose heartbeats do not arrive: it stands by, each time for twice as long.
  if (is_active() && !is_granting) return begin_epoch(now, cause);
  if (is_active()) backoff_exponent_ = std::min(backoff_exponent_ + 1, kMaxBackoffExponent);
  stand_by(now, cause);
}

RoleCause Failover::takeover_cause(Time now) const {
  const Duration silence = now - last_heartbeat_;
  if (is_starting_) return {msg::RoleReason::ROLE_NO_COORDINATOR, 0, silence, 0};
  if (!heard_) return {msg::RoleReason::ROLE_RETURNED, 0, silence, 0};
  return {msg::RoleReason::ROLE_HEARTBEATS_LOST, *heard_, silence, 0};
}

Duration Failover::takeover_timeout() const {
  if (is_starting_) return kStartTimeout + kStartTimeoutStagger * self_.number;
  const Duration longest_gap = *std::max_element(gaps_.begin(), gaps_.end());
  return (kHeartbeatTimeout + kTimeoutStagger * self_.number +
          std::min(std::max(longest_gap, kHeartbeatPeriod), kStartTimeout)) *
         (1 << backoff_exponent_);
}

void Failover::update(Time now) {
  if (now - last_update_ > kPauseThreshold) {
    last_heartbeat_ = now;
    has_heartbeat_ = false;
  }
  last_update_ = now;
  if (!is_active() && now - last_heartbeat_ > takeover_timeout()) begin_epoch(now, takeover_cause(now));
}

}  // namespace sidestep
