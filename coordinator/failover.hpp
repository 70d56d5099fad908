// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "common/messaging/senders.hpp"
#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/role_cause.hpp"
#include "common/time/rate_limit.hpp"

namespace sidestep {

/// Number of a coordinator among those that stand by for each other, 0 .. kMaxCoordinators - 1.
using CoordinatorNumber = std::uint32_t;

/// One instance of a coordinator process.
struct CoordinatorIdentity {
  CoordinatorNumber number = 0;
  Incarnation incarnation = 0;
};

/// The process that obeys an epoch.
enum class EpochHolder { kRobot, kAgent };

/// Decides whether this coordinator is active. It stands by while it receives heartbeats of another one,
/// takes over when they stop, and stands by again when it learns of a higher epoch. Its clock affects only
/// when robots move again, not safety: two coordinators that both consider themselves active have different
/// epochs, and robots obey the higher one.
class Failover {
 public:
  /// Period of an active coordinator's heartbeats.
  static constexpr Duration kHeartbeatPeriod{20'000'000};
  /// Period of update().
  static constexpr Duration kUpdatePeriod{5'000'000};

  /// A standby waits at least a second for other coordinators; otherwise an epoch begins immediately.
  Failover(const CoordinatorIdentity& self, bool is_standby, Time now);

  /// A heartbeat of any coordinator, including this one.
  void on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now);
  /// A robot or its agent obeys this epoch. `is_granting`: whether this coordinator grants at present. Such
  /// reports are repeated, and may be forged: only a few of them at once and then one in five seconds count.
  void on_obeyed_epoch(Epoch epoch, bool is_granting, Time now, RobotId robot, EpochHolder holder);
  /// Takes over if the heartbeats have stopped.
  void update(Time now);
  bool is_active() const { return epoch_ != 0; }
  /// The epoch of this coordinator; 0 while it stands by.
  Epoch epoch() const { return epoch_; }
  /// Why this coordinator is active in its epoch, or stands by.
  const RoleCause& cause() const { return cause_; }
  /// Silence after which a standby takes over; longer if heartbeats have been irregular.
  Duration takeover_timeout() const;
  /// Number of obeyed epochs that were ignored because they were implausible.
  std::uint64_t invalid() const { return invalid_; }
  /// Number of reports of higher epochs that were ignored because there were too many.
  std::uint64_t too_frequent() const { return too_frequent_; }

 private:
  /// Begins a new epoch, above every known one.
  void begin_epoch(Time now, const RoleCause& cause);
  /// Yields if it is active. Then the timeout begins anew.
  void stand_by(Time now, const RoleCause& cause);
  RoleCause takeover_cause(Time now) const;
  void record_heartbeat(Time now);

  CoordinatorIdentity self_;
  Epoch epoch_ = 0, highest_ = 0;  // own epoch, and the highest known one
  RoleCause cause_;
  Time last_heartbeat_, last_update_;
  std::array<Duration, 32> gaps_{};  // between the latest heartbeats
  std::size_t heartbeat_count_ = 0;
  bool has_heartbeat_ = false;  // last_heartbeat_ is the time of a heartbeat, not of a change of role
  std::optional<CoordinatorNumber> heard_;  // the last coordinator whose heartbeat has reset the timeout
  bool is_starting_;                        // a standby that has received no heartbeat yet
  RateLimit obeyed_epochs_{4, std::chrono::seconds(5)};
  int backoff_exponent_ = 0;  // consecutive supersessions by a coordinator whose heartbeats do not arrive
  std::uint64_t invalid_ = 0, too_frequent_ = 0;
};

}  // namespace sidestep
