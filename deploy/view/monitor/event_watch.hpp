// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "common/protocol/order.hpp"
#include "common/time/rate_limit.hpp"
#include "deploy/audit/audit_rules.hpp"
#include "deploy/inspect/floor/floor_state.hpp"
#include "deploy/view/monitor/event_log.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

/// Finds events that are of interest to people in the messages of a run, and adds them to a log.
class EventWatch {
 public:
  /// The log must outlive this object.
  explicit EventWatch(EventLog& log) : log_(log) {}

  void on(const msg::GroundTruth& truth, Time now);
  void on(const msg::Feedback& feedback, Time now);
  void on(const msg::AgentStatus& status, Time now);
  void on(const msg::OrderStatus& status, Time now);
  void on(const msg::CoordinatorState& state, Time now);
  void on(const msg::Order& order, Time now);
  void on(const msg::OrderAnswer& answer, Time now);
  void on(const msg::Disturbance& disturbance, Time now);
  void on(const msg::DisturbanceAnswer& answer, Time now);
  void on(const msg::NetworkFault& fault, Time now);
  void on(const msg::AbsenceAttestation& attestation, Time now);
  void on_violation(const Violation& violation);
  /// Records a process whose messages are refused because its rules differ.
  void on_refused(std::uint32_t sender, Time now);
  /// Detects robots and coordinators that have fallen silent.
  void tick(const FloorState& floor, Time now);

  /// An agent, a robot or an active coordinator that is silent for this long causes an event.
  static constexpr Duration kSilence = std::chrono::milliseconds(1000);

 private:
  /// Properties of robots and coordinators whose last values are kept to detect changes.
  enum class Watched : std::uint8_t {
    kOffReference,
    kLifted,
    kAgent,
    kAgentState,
    kHeld,
    kOrder,
    kCoordinator,
    kNotice,
    kSilent
  };

  void add(Severity severity, std::string kind, std::string text, Time at, std::vector<RobotId> robots = {});
  /// Stores the last value with this key. Returns whether it has changed; the first value counts as a change
  /// if it is not `normal`.
  bool store_if_changed(Watched what, std::uint32_t id, std::uint64_t value, std::uint64_t normal = 0);
  void watch_silence(std::uint32_t id, bool is_silent, const std::string& name, bool is_robot, Time now);

  /// Stores the number and the client's name of the sender's last order. Returns false if the order is a
  /// repetition.
  bool store_order(const msg::Order& order);
  /// "the operator", "client kitchen"; the number of a client whose name no order has told.
  std::string phrase_of(ClientId client) const;

  EventLog& log_;
  /// Limits events that any participant in the network can cause.
  RateLimit external_event_limit_{1000, std::chrono::milliseconds(10)};
  struct SentOrder {
    std::uint64_t number = 0;
    ClientName name{};
  };
  std::map<ClientId, SentOrder> sent_orders_;  ///< the last order, by sender
  std::set<std::uint32_t> refused_;            ///< senders whose messages were refused
  std::map<std::pair<Watched, std::uint32_t>, std::uint64_t> last_;
  struct TruthTotals {
    std::uint64_t incarnation = 0, contacts = 0, crashes = 0, violations = 0;
  };
  std::optional<TruthTotals> totals_;
};

}  // namespace sidestep
