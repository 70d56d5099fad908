// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <set>
#include <vector>

#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/role_cause.hpp"
#include "common/protocol/senders.hpp"
#include "common/time/rate_limit.hpp"
#include "coordinator/fleet_reception.hpp"

namespace sidestep {

/// Number of a coordinator among those that stand by for each other, 0 .. kMaxCoordinators - 1.
using CoordinatorNumber = std::uint32_t;

/// The Header.sender that this coordinator uses.
constexpr std::uint32_t process_of(CoordinatorNumber number) {
  return static_cast<std::uint32_t>(Sender::kCoordinator) + number;
}

/// One instance of a coordinator process.
struct CoordinatorIdentity {
  CoordinatorNumber number = 0;
  Incarnation incarnation = 0;
};

/// Who obeys an epoch.
enum class EpochHolder { kRobot, kAgent };

/// The fleet that coordinators serve.
struct FleetSpec {
  std::vector<RobotId> roster{};
  Duration report_period{16'666'667};  ///< period at which robots report facts
};

/// Decides whether this coordinator is active. It stands by while it receives heartbeats of another
/// coordinator, takes over when they stop, and stands by again when it learns of a higher epoch. It also
/// takes over if the active coordinator does not serve an agent that repeatedly asks for one. It never takes
/// over while it does not hear the robots. Its clock affects only when robots move again, not safety: two
/// coordinators that both consider themselves active have different epochs, and robots obey the higher one.
class Failover {
 public:
  /// Period of an active coordinator's heartbeats.
  static constexpr Duration kHeartbeatPeriod{20'000'000};
  /// Period of update().
  static constexpr Duration kUpdatePeriod{5'000'000};

  /// After an agent has asked for this long without being registered, the active coordinator is assumed not
  /// to hear it.
  static constexpr Duration kRegistrationTime{400'000'000};
  /// Like kRegistrationTime, but for an agent that may be registered already and is not served.
  static constexpr Duration kServiceTime{500'000'000};

  /// A standby waits at least a second for other coordinators. A coordinator that is not a standby begins an
  /// epoch immediately.
  Failover(const CoordinatorIdentity& self, bool is_standby, Time now, const FleetSpec& fleet = {});

  /// Processes a heartbeat of any coordinator, including this one.
  void on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now);
  /// Processes a report that a robot or its agent obeys this epoch. `is_granting` tells whether this
  /// coordinator is granting now. Such reports are repeated and may be forged, so only a burst of four, and
  /// then one report every five seconds, count.
  void on_obeyed_epoch(Epoch epoch, bool is_granting, Time now, RobotId robot, EpochHolder holder);
  /// The record of messages from robots and their agents.
  FleetReception& reception() { return reception_; }
  /// Takes over if that is due. `is_granting` tells whether this coordinator is granting now.
  void update(Time now, bool is_granting = false);
  bool is_active() const { return epoch_ != 0; }
  /// The epoch in which this coordinator is active; 0 while it is a standby.
  Epoch epoch() const { return epoch_; }
  /// Why this coordinator is active in its epoch, or is a standby.
  const RoleCause& cause() const { return cause_; }
  /// Silence after which a standby takes over; longer if heartbeats have been irregular.
  Duration takeover_timeout() const;
  /// Number of obeyed epochs that were ignored because they were implausible.
  std::uint64_t invalid() const { return invalid_; }
  /// Number of reports of higher epochs that were ignored because there were too many.
  std::uint64_t too_frequent() const { return too_frequent_; }

 private:
  /// Begins a new epoch, higher than all known epochs.
  void begin_epoch(Time now, const RoleCause& cause);
  /// Yields if this coordinator is active. Then restarts the timeout.
  void stand_by(Time now, const RoleCause& cause);
  RoleCause takeover_cause(Time now) const;
  void record_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now);
  void observe_own_service(Time now, bool is_granting);
  bool is_takeover_due(Time now) const;
  /// Whether another coordinator grants but its heartbeats do not arrive.
  bool is_served_by_other(Time now) const;
  /// A robot whose agent the active coordinator does not serve, but this coordinator might.
  std::optional<RobotId> unserved_robot(Time now) const;
  /// Whether the agent has asked long enough for this coordinator to take over.
  bool is_request_overdue(RobotId robot, Duration first, Time now) const;
  /// Whether any agent has asked for a coordinator for at least `min`.
  bool is_any_unserved(Duration min, Time now) const;

  CoordinatorIdentity self_;
  std::vector<RobotId> roster_;
  FleetReception reception_;
  std::set<RobotId> missing_;  // robots missing according to the active coordinator's last heartbeat
  Time active_since_{};
  Time last_without_robots_at_;          // last time at which this coordinator did not hear the robots
  std::optional<Time> serving_since_;    // start of the time in which it grants and serves all agents
  bool has_served_ = false;              // whether serving_since_ was ever set since it became active
  bool has_begun_above_obeyed_ = false;  // whether it has begun an epoch above an obeyed epoch while active
  int failures_ = 0;                     // number of consecutive times that it was active without serving
  Epoch epoch_ = 0, highest_ = 0;        // own epoch; highest known epoch
  RoleCause cause_;
  Time last_heartbeat_, last_update_;
  std::array<Duration, 32> gaps_{};  // intervals between the latest heartbeats
  std::size_t heartbeat_count_ = 0;
  bool has_heartbeat_ = false;  // last_heartbeat_ is the time of a heartbeat, not of a change of role
  std::optional<CoordinatorNumber> heard_;  // the last coordinator whose heartbeat has restarted the timeout
  bool is_starting_;                        // a standby that has received no heartbeat yet
  RateLimit obeyed_epochs_{4, std::chrono::seconds(5)};
  int backoff_exponent_ = 0;  // consecutive supersessions by an unheard coordinator
  std::uint64_t invalid_ = 0, too_frequent_ = 0;
};

}  // namespace sidestep
