// SPDX-License-Identifier: Apache-2.0
#include "coordinator/failover.hpp"

#include <algorithm>

#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

// Time that is added to the longest recent gap between heartbeats.
constexpr Duration kHeartbeatTimeout{100'000'000};
// Time that is added per coordinator number to keep standbys from taking over simultaneously.
constexpr Duration kTimeoutStagger{25'000'000};
// A standby that has just started may not have been discovered by the other coordinators yet.
constexpr Duration kStartTimeout{1'000'000'000};
constexpr Duration kStartTimeoutStagger{200'000'000};
// After a pause of this length, unprocessed heartbeats may be queued.
constexpr Duration kPauseThreshold{60'000'000};
constexpr int kMaxBackoffExponent = 2;
// An attempt to serve does not count as a failure if the coordinator is superseded earlier than this.
constexpr Duration kMinAttempt{200'000'000};
constexpr int kMaxFailures = 4;
// While no robot moves, a failed attempt costs nothing.
constexpr int kMaxFailuresAtRest = 1;
constexpr Duration kRestTime{1'000'000'000};
// If robots begin to execute granted versions at least this often, they are served by another coordinator
// whose heartbeats do not arrive here.
constexpr Duration kServiceGap{60'000'000};
// The robots are also served by another coordinator if they still begin granted versions this long after the
// last heartbeat. In that case they may pause for up to kMaxPauseOfService.
constexpr Duration kServiceAfterHeartbeat{500'000'000};
constexpr Duration kMaxPauseOfService{1'000'000'000};
// A superseded coordinator has failed if an agent has asked it for this long; an agent that only measures the
// clock asks for a shorter time.
constexpr Duration kMinRequest{150'000'000};
// An active coordinator that has served for this long has not failed.
constexpr Duration kProbation{1'000'000'000};
// If two instances with the same number begin epochs above the same known epoch, they choose different
// epochs, because each adds its incarnation modulo this number.
constexpr Epoch kEpochSpread = 1'000'003;

}  // namespace

Failover::Failover(const CoordinatorIdentity& self, bool is_standby, Time now, const FleetSpec& fleet)
    : self_(self),
      roster_(fleet.roster),
      reception_(fleet.report_period),
      last_without_robots_at_(now),
      last_heartbeat_(now),
      last_update_(now),
      is_starting_(is_standby) {
  if (!is_standby) begin_epoch(now, {});
}

void Failover::begin_epoch(Time now, const RoleCause& cause) {
  if (!is_active()) {
    active_since_ = now;
    has_served_ = has_begun_above_obeyed_ = false;
  }
  serving_since_.reset();
  reception_.forget_requests();
  cause_ = cause;
  const Epoch above = highest_ == 0 ? 0 : highest_ + 1 + self_.incarnation % kEpochSpread;
  const Epoch min_epoch =
      std::max<Epoch>({above, static_cast<Epoch>(std::max<std::int64_t>(to_ns(now), 0)), 1});
  // The epoch modulo kMaxCoordinators is the coordinator's number, so different numbers never share an epoch.
  epoch_ = min_epoch + (kMaxCoordinators + self_.number - min_epoch % kMaxCoordinators) % kMaxCoordinators;
  highest_ = epoch_;
  is_starting_ = false;
}

void Failover::stand_by(Time now, const RoleCause& cause) {
  if (is_active()) {
    cause_ = cause;
    heard_.reset();
    const bool has_tried = now - active_since_ > kMinAttempt;
    if (has_tried && (!has_served_ || is_any_unserved(kMinRequest, now)))
      failures_ = std::min(failures_ + 1, kMaxFailures);
  }
  reception_.forget_requests();
  missing_.clear();
  epoch_ = 0;
  last_heartbeat_ = now;
  has_heartbeat_ = false;
}

void Failover::record_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now) {
  missing_.clear();
  for (const msg::RobotNotice& notice : heartbeat.notices)
    if (notice.is_missing()) missing_.insert(notice.robot());
  if (has_heartbeat_) gaps_[heartbeat_count_++ % gaps_.size()] = now - last_heartbeat_;
  has_heartbeat_ = true;
  last_heartbeat_ = now;
  is_starting_ = false;
  backoff_exponent_ = 0;
}

void Failover::on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now) {
  const bool is_own =
      heartbeat.sender == process_of(self_.number) && heartbeat.incarnation == self_.incarnation;
  if (is_own || heartbeat.epoch == 0 || heartbeat.mode == msg::CoordinatorMode::COORDINATOR_STANDBY) return;
  if (heartbeat.epoch < highest_) return;
  const CoordinatorNumber number = heartbeat.sender - static_cast<std::uint32_t>(Sender::kCoordinator);
  if (is_active() && heartbeat.epoch == epoch_) {
    const RoleCause shared{msg::RoleReason::ROLE_SHARED_EPOCH, number, Duration{0}, heartbeat.epoch};
    // Two instances with the same number share an epoch, so the grants of neither can be trusted.
    if (heartbeat.incarnation < self_.incarnation) return begin_epoch(now, shared);
    return stand_by(now, shared);
  }
  const bool is_new_epoch = heartbeat.epoch > highest_;
  highest_ = heartbeat.epoch;
  if (is_active()) {
    stand_by(now, {msg::RoleReason::ROLE_EPOCH_OF_COORDINATOR, number, Duration{0}, heartbeat.epoch});
  } else {
    record_heartbeat(heartbeat, now);
  }
  if (is_new_epoch) reception_.forget_requests();
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
  // Once after becoming active, a coordinator begins a new epoch above the obeyed epoch. If it already
  // grants, has waited for registrations in vain, or is superseded again, it has a rival whose heartbeats do
  // not arrive. It then stands by, each time for twice as long.
  const bool is_new = now - active_since_ <= kRegistrationTime && !has_begun_above_obeyed_;
  if (is_active() && !is_granting && is_new) {
    has_begun_above_obeyed_ = true;
    return begin_epoch(now, cause);
  }
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
  // Earlier failures of this coordinator do not matter while it hears another coordinator.
  const int failures = has_heartbeat_ ? 0 : std::min(failures_, kMaxBackoffExponent);
  const Duration longest_gap = *std::max_element(gaps_.begin(), gaps_.end());
  return (kHeartbeatTimeout + kTimeoutStagger * self_.number +
          std::min(std::max(longest_gap, kHeartbeatPeriod), kStartTimeout)) *
         (1 << std::max(backoff_exponent_, failures));
}

void Failover::update(Time now, bool is_granting) {
  const bool was_set_back = now < last_update_;
  if (was_set_back || now - last_update_ > kPauseThreshold) {
    last_heartbeat_ = last_without_robots_at_ = now;
    active_since_ = std::min(active_since_, now);
    serving_since_.reset();
    has_heartbeat_ = false;
    reception_.forget_requests();
  }
  if (was_set_back) reception_.clear();
  last_update_ = now;
  if (!reception_.hears_robots(now)) last_without_robots_at_ = now;
  if (is_active()) return observe_own_service(now, is_granting);
  if (is_takeover_due(now)) return begin_epoch(now, takeover_cause(now));
  if (const auto robot = unserved_robot(now))
    begin_epoch(now, {msg::RoleReason::ROLE_EPOCH_OF_AGENT, *robot, Duration{0}, 0});
}

void Failover::observe_own_service(Time now, bool is_granting) {
  if (!is_granting || is_any_unserved(kRegistrationTime, now)) {
    serving_since_.reset();
    return;
  }
  has_served_ = true;
  if (!serving_since_) serving_since_ = now;
  if (now - *serving_since_ >= kProbation) failures_ = 0;
}

// A coordinator that hears no robots cannot serve them. The stagger keeps several coordinators that hear
// robots again from taking over simultaneously.
bool Failover::is_takeover_due(Time now) const {
  return now - last_heartbeat_ > takeover_timeout() &&
         now - last_without_robots_at_ > kTimeoutStagger * self_.number && !is_served_by_other(now);
}

bool Failover::is_served_by_other(Time now) const {
  const bool has_unheard_coordinator =
      reception_.served_at() && *reception_.served_at() - last_heartbeat_ >= kServiceAfterHeartbeat;
  return reception_.is_fleet_served(has_unheard_coordinator ? kMaxPauseOfService : kServiceGap, now);
}

std::optional<RobotId> Failover::unserved_robot(Time now) const {
  if (highest_ == 0 || now - last_without_robots_at_ <= kTimeoutStagger * self_.number) return std::nullopt;
  for (const RobotId robot : missing_)
    if (is_request_overdue(robot, kRegistrationTime, now)) return robot;
  // Another coordinator may be serving the other agents, so this coordinator must hear all of them.
  if (!reception_.hears_agents(roster_, now) || !reception_.hears_vision(now)) return std::nullopt;
  for (const RobotId robot : roster_)
    if (is_request_overdue(robot, kServiceTime, now)) return robot;
  return std::nullopt;
}

bool Failover::is_request_overdue(RobotId robot, Duration first, Time now) const {
  const bool is_at_rest = !reception_.is_fleet_served(kRestTime, now);
  const int failures = is_at_rest ? std::min(failures_, kMaxFailuresAtRest) : failures_;
  const Duration needed = first * (1 << failures);
  // Agents repeat requests at intervals, which would synchronise the coordinators that react. The stagger
  // prevents that.
  return reception_.request_duration(robot, now) >= needed - FleetReception::kMaxRequestGap / 3 &&
         reception_.time_since_first_request(robot, now) >= needed + 2 * kTimeoutStagger * self_.number;
}

bool Failover::is_any_unserved(Duration min, Time now) const {
  return std::ranges::any_of(roster_,
                             [&](RobotId robot) { return reception_.request_duration(robot, now) >= min; });
}

}  // namespace sidestep
