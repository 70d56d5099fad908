// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "common/motion/version.hpp"
#include "common/protocol/client_name.hpp"
#include "deploy/audit/audit_rules.hpp"
#include "deploy/audit/comparable_stamps.hpp"
#include "idl/negotiation.hpp"
#include "idl/order.hpp"

namespace sidestep {

/// Audits orders (coordinator/ORDERS.md), using only complete memories of coordinators. An order that such a
/// memory lists was in force at that moment. An order was forgotten if the memory neither lists it nor names
/// a later order in its place. So missed messages leave orders unjudged, but never look like a violation.
class OrderAudit {
 public:
  using Report = std::function<void(AuditRule, RobotId, VersionNumber, Epoch, std::string)>;
  /// `is_complete` means that every message is received; only then does the audit know what each agent
  /// remembers. `stamps` must outlive the audit, and must have recorded each message before it is passed
  /// here.
  OrderAudit(std::vector<RobotId> roster, bool is_complete, const ComparableStamps& stamps, Report report);

  void on_order(const msg::Order& order);
  void on_answer(const msg::OrderAnswer& answer);
  /// Processes a memory of a coordinator or an agent.
  void on_memory(const msg::OrderMemory& memory);
  void on_status(const msg::OrderStatus& status);
  void on_registration(const msg::Registration& registration);
  /// Processes a verdict that grants a version to a robot on the floor. `earliest_ns`: the version may have
  /// been granted by an earlier verdict, but not before this time by the coordinator's clock. kAlways: there
  /// was no earlier verdict.
  void on_grant(const msg::Verdict& verdict, std::int64_t earliest_ns);

 private:
  enum class SubjectKind : std::uint8_t { kDrive, kHold, kResume, kZone };
  /// The subject of an order. Of two orders with the same subject, only the later one counts.
  using Subject = std::tuple<SubjectKind, std::uint32_t, std::uint32_t, std::uint32_t>;
  struct Terms {
    Subject subject;
    std::uint32_t client = 0;
    std::uint64_t number = 0;
    msg::OrderKind kind = msg::OrderKind::ORDER_GO;
    std::uint32_t robot = 0;
    ClientName client_name{};
  };
  using Key = std::pair<std::uint64_t, std::uint32_t>;  // number and client of an order
  /// An agent that is known to remember an order.
  struct Witness {
    Incarnation incarnation = 0;
    std::int64_t stamp_ns = 0;
  };
  using Witnesses = std::map<RobotId, Witness>;
  struct Confirmed {
    Terms terms;
    std::uint32_t coordinator = 0;
    Incarnation incarnation = 0;
    std::int64_t stamp_ns = 0;
  };
  struct Grant {
    std::int64_t stamp_ns = 0;
    std::int64_t earliest_ns = 0;
    VersionNumber version = 0;
    Epoch epoch = 0;
  };
  /// One run of a coordinator. All stamps are by its clock, which must not be set back.
  struct Coordinator {
    Incarnation incarnation = 0;
    std::map<Key, std::int64_t> announced_ns;  // when it first announced each hold that it remembers
    std::map<RobotId, Grant> grants;           // latest grants
    Epoch epoch = 0;                           // epoch of the latest grant
    std::int64_t granting_since_ns = 0;        // time of the first grant in that epoch
    std::vector<Terms> memory;                 // pages of a complete memory received so far
    std::uint64_t first_message = 0, pages = 0;
    std::int64_t memory_stamp_ns = 0;
  };
  struct AgentRegistration {
    Incarnation incarnation = 0;
    Epoch epoch = 0;
    std::int64_t stamp_ns = 0;
  };
  struct HeldFlag {
    Incarnation incarnation = 0;
    std::uint64_t message = 0;
    bool is_set = false;
    std::optional<Key> cause;  // the only hold that was sent while is_set was false
    bool has_several_causes = false;
  };
  /// A coordinator's complete memory, indexed by subject.
  class Memory;

  static Terms terms_of(std::uint32_t robot, std::uint32_t client, const msg::OrderTerms& terms);
  Coordinator* coordinator_of(const msg::Header& header);
  void on_agent_memory(const msg::OrderMemory& memory);
  void judge(std::uint32_t sender, Coordinator& coordinator, bool claims_completeness);
  void judge_grants(const Memory& memory, Coordinator& coordinator);
  void judge_confirmed(const Memory& memory, std::uint32_t sender, const Coordinator& coordinator,
                       bool claims_completeness);
  /// Whether an agent that is known to remember the order has since registered in the epoch.
  bool has_witness(const Terms& terms, Epoch epoch) const;
  void add_witness(const Key& key, RobotId robot, const Witness& witness);

  const std::vector<RobotId> roster_;  // sorted
  const bool is_complete_;
  const ComparableStamps& stamps_;
  const Report report_;
  std::map<std::uint32_t, Coordinator> coordinators_;  // indexed by sender
  std::map<Key, Terms> sent_;                          // bounded; the lowest numbers are forgotten first
  std::map<Subject, Confirmed> confirmed_;             // latest order for each subject; bounded
  std::map<Key, Witnesses> witnesses_;                 // bounded; the lowest numbers are forgotten first
  std::map<RobotId, AgentRegistration> registered_;    // latest registrations
  std::map<RobotId, HeldFlag> held_;
  /// Whether some coordinator may have forgotten why holds or zones are no longer in force.
  bool may_miss_resumes_ = false, may_miss_removals_ = false;
};

}  // namespace sidestep
