// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <set>
#include <vector>

#include "common/messaging/senders.hpp"
#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/role_cause.hpp"
#include "common/time/rate_limit.hpp"
#include "coordinator/fleet_reception.hpp"

namespace sidestep {

/// Number of a coordinator among those that stand by for each other, 0 .. kMaxCoordinators - 1.
using CoordinatorNumber = std::uint32_t;

/// What this coordinator states as Header.sender.
constexpr std::uint32_t process_of(CoordinatorNumber number) {
  return static_cast<std::uint32_t>(Sender::kCoordinator) + number;
}

/// One instance of a coordinator process.
struct CoordinatorIdentity {
  CoordinatorNumber number = 0;
  Incarnation incarnation = 0;
};

/// The process that obeys an epoch.
enum class EpochHolder { kRobot, kAgent };

/// The fleet that coordinators serve.
struct FleetSpec {
  std::vector<RobotId> roster{};
  Duration fact_period{16'666'667};  ///< at which robots report facts
};

/// Decides whether this coordinator is active. It stands by while it receives heartbeats of another one,
/// takes over when they stop, and stands by again when it learns of a higher epoch. It also takes over if the
/// active one does not serve an agent that asks for a coordinator again and again. A coordinator that does
/// not hear the robots never takes over. Its clock affects only when robots move again, not safety: two
/// coordinators that both consider themselves active have different epochs, and robots obey the higher one.
class Failover {
 public:
  /// Period of an active coordinator's heartbeats.
  static constexpr Duration kHeartbeatPeriod{20'000'000};
  /// Period of update().
  static constexpr Duration kUpdatePeriod{5'000'000};

  /// An agent that has asked for this long without being registered is not heard by the active coordinator.
  static constexpr Duration kRegistrationTime{400'000'000};
  /// The same of an agent that may be registered, but is not served.
  static constexpr Duration kServiceTime{500'000'000};

  /// A standby waits at least a second for other coordinators; otherwise an epoch begins immediately.
  Failover(const CoordinatorIdentity& self, bool is_standby, Time now, const FleetSpec& fleet = {});

  /// A heartbeat of any coordinator, including this one.
  void on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now);
  /// A robot or its agent obeys this epoch. `is_granting`: whether this coordinator grants at present. Such
  /// reports are repeated, and may be forged: only a few of them at once and then one in five seconds count.
  void on_obeyed_epoch(Epoch epoch, bool is_granting, Time now, RobotId robot, EpochHolder holder);
  /// What arrives of robots and their agents.
  FleetReception& reception() { return reception_; }
  /// Takes over if that is due. `is_granting`: whether this coordinator grants at present.
  void update(Time now, bool is_granting = false);
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
  void record_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now);
  void observe_own_service(Time now, bool is_granting);
  bool are_heartbeats_lost(Time now) const;
  /// Whether somebody grants whose heartbeats do not arrive.
  bool is_served_by_other(Time now) const;
  /// A robot whose agent the active coordinator does not serve, although this one might.
  std::optional<RobotId> unserved_robot(Time now) const;
  /// Whether the agent has asked for so long that this coordinator takes over.
  bool has_asked_long(RobotId robot, Duration first, Time now) const;
  /// Whether any agent has asked for a coordinator for this long.
  bool is_any_unserved(Duration min, Time now) const;

  CoordinatorIdentity self_;
  std::vector<RobotId> roster_;
  FleetReception reception_;
  std::set<RobotId> missing_;  // by the last heartbeat of the active coordinator
  Time active_since_{};
  Time unheard_at_;                    // when robots were not heard last
  std::optional<Time> serving_since_;  // since when it grants, and no agent asks in vain
  bool has_served_ = false;            // the same, since it became active
  bool has_risen_ = false;             // has begun above an obeyed epoch since it became active
  int failures_ = 0;                   // consecutive times that it was active without serving
  Epoch epoch_ = 0, highest_ = 0;      // own epoch, and the highest known one
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
