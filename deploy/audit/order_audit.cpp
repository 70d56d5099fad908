// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/order_audit.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/protocol/client_text.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/audit/audited_robot.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxKept = 4096;
// Of clients' resumes, a coordinator keeps at least the latest 512 and those that exempt a robot from a hold
// of all robots that is in force; of removals of zones, the latest 256. If a complete memory contains half as
// many, the coordinator may forget some before the next memory.
constexpr std::size_t kManyResumes = 256, kManyRemovals = 128;
constexpr auto kOperator = static_cast<std::uint32_t>(Sender::kOperator);
// Clients other than operator, referee and scenario share one entry for orders to drive.
constexpr std::uint32_t kAnyClient = 0;

std::uint32_t driver_of(std::uint32_t client) {
  const bool is_named = client == kOperator || client == static_cast<std::uint32_t>(Sender::kReferee) ||
                        client == static_cast<std::uint32_t>(Sender::kScenario);
  return is_named ? client : kAnyClient;
}

template <typename Map>
void bound(Map& map) {
  while (map.size() > kMaxKept) map.erase(map.begin());
}

std::string name_of(msg::OrderKind kind) {
  switch (kind) {
    case msg::OrderKind::ORDER_GO:
      return "order to go";
    case msg::OrderKind::ORDER_CANCEL:
      return "cancellation";
    case msg::OrderKind::ORDER_HOLD:
      return "hold";
    case msg::OrderKind::ORDER_RESUME:
      return "resume";
    case msg::OrderKind::ORDER_ZONE:
      return "zone";
    case msg::OrderKind::ORDER_REMOVE_ZONE:
      break;
  }
  return "removal of a zone";
}

}  // namespace

class OrderAudit::Memory {
 public:
  explicit Memory(const std::vector<Terms>& orders) {
    for (const Terms& order : orders) by_subject_[order.subject] = order;
    for (const Terms& order : orders) {
      const bool is_of_client = driver_of(order.client) == kAnyClient;
      resumes_ += order.kind == msg::OrderKind::ORDER_RESUME && is_of_client && !is_exempting(order);
      removals_ += order.kind == msg::OrderKind::ORDER_REMOVE_ZONE;
    }
  }

  /// The number of the latest resume of this client or an operator, for exactly this robot or all robots;
  /// 0: there is none.
  std::uint64_t last_resume(std::uint32_t client, std::uint32_t scope) const {
    std::uint64_t last = 0;
    for (const std::uint32_t by : {client, kOperator}) {
      const auto found = by_subject_.find({SubjectKind::kResume, scope, by, 0});
      if (found != by_subject_.end()) last = std::max(last, found->second.number);
    }
    return last;
  }
  /// Whether the order is in force, or the memory shows why it is not.
  bool accounts_for(const Terms& order) const {
    const auto found = by_subject_.find(order.subject);
    if (found != by_subject_.end() &&
        std::pair(found->second.number, found->second.client) >= std::pair(order.number, order.client))
      return true;
    const std::uint64_t resumed =
        std::max(last_resume(order.client, order.robot), last_resume(order.client, msg::ALL_ROBOTS));
    switch (std::get<SubjectKind>(order.subject)) {
      case SubjectKind::kDrive:
        return false;
      case SubjectKind::kHold:
        return resumed > order.number;
      case SubjectKind::kZone:
        return false;
      case SubjectKind::kResume:
        break;
    }
    // Otherwise, the absence of the hold shows that it was lifted.
    return !is_exempting(order) || resumed >= order.number;
  }
  /// Whether the resume exempts a robot from a hold of all robots that is in force.
  bool is_exempting(const Terms& resume) const {
    const auto hold = by_subject_.find({SubjectKind::kHold, msg::ALL_ROBOTS, resume.client, 0});
    return resume.robot != msg::ALL_ROBOTS && hold != by_subject_.end() &&
           hold->second.number < resume.number;
  }
  bool has_many_resumes() const { return resumes_ >= kManyResumes; }
  bool has_many_removals() const { return removals_ >= kManyRemovals; }
  const std::map<Subject, Terms>& orders() const { return by_subject_; }

 private:
  std::map<Subject, Terms> by_subject_;
  std::size_t resumes_ = 0, removals_ = 0;
};

OrderAudit::OrderAudit(std::vector<RobotId> roster, bool is_complete, const ComparableStamps& stamps,
                       Report report)
    : roster_(std::move(roster)), is_complete_(is_complete), stamps_(stamps), report_(std::move(report)) {}

OrderAudit::Terms OrderAudit::terms_of(std::uint32_t robot, std::uint32_t client,
                                       const msg::OrderTerms& terms) {
  Terms order{{}, client, terms.order_number(), terms.order_kind(), robot};
  if (is_name_of(terms.client_name(), client)) order.client_name = terms.client_name();
  switch (order.kind) {
    case msg::OrderKind::ORDER_GO:
    case msg::OrderKind::ORDER_CANCEL:
      order.subject = {SubjectKind::kDrive, robot, driver_of(client), 0};
      break;
    case msg::OrderKind::ORDER_HOLD:
      order.subject = {SubjectKind::kHold, robot, client, 0};
      break;
    case msg::OrderKind::ORDER_RESUME:
      order.subject = {SubjectKind::kResume, robot, client, 0};
      break;
    case msg::OrderKind::ORDER_ZONE:
    case msg::OrderKind::ORDER_REMOVE_ZONE:
      order.subject = {SubjectKind::kZone, robot, client, terms.zone()};
      break;
  }
  return order;
}

OrderAudit::Coordinator* OrderAudit::coordinator_of(const msg::Header& header) {
  if (!is_coordinator(header.sender()) || !stamps_.are_in_order(header.sender(), header.incarnation()))
    return nullptr;
  Coordinator& coordinator = coordinators_[header.sender()];
  if (header.incarnation() < coordinator.incarnation) return nullptr;
  if (header.incarnation() > coordinator.incarnation) {
    coordinator = {};
    coordinator.incarnation = header.incarnation();
  }
  return &coordinator;
}

void OrderAudit::on_order(const msg::Order& message) {
  const Terms order = terms_of(message.robot(), message.header().sender(), message.terms());
  const Key key{order.number, order.client};
  sent_[key] = order;
  bound(sent_);
  if (order.kind != msg::OrderKind::ORDER_HOLD) return;
  for (auto& [robot, flag] : held_) {
    if ((order.robot != robot && order.robot != msg::ALL_ROBOTS) || flag.is_set) continue;
    flag.has_several_causes |= flag.cause && *flag.cause != key;
    flag.cause = key;
  }
}

void OrderAudit::on_answer(const msg::OrderAnswer& answer) {
  const Coordinator* coordinator = coordinator_of(answer.header());
  if (!coordinator || answer.result() != msg::OrderResult::RESULT_REMEMBERED) return;
  const auto sent = sent_.find({answer.order_number(), answer.client()});
  if (sent == sent_.end()) return;  // The order was missed, or its repetition has another number.
  const Terms& order = sent->second;
  Confirmed& last = confirmed_[order.subject];
  if (std::pair(last.terms.number, last.terms.client) < std::pair(order.number, order.client))
    last = {order, answer.header().sender(), coordinator->incarnation, answer.header().stamp_ns()};
  if (confirmed_.size() <= kMaxKept) return;
  confirmed_.erase(
      std::ranges::min_element(confirmed_, {}, [](const auto& entry) { return entry.second.terms.number; }));
}

void OrderAudit::on_status(const msg::OrderStatus& status) {
  const RobotId robot = status.robot();
  if (!std::ranges::binary_search(roster_, robot) || status.header().sender() != robot) return;
  const Witness witness{status.header().incarnation(), status.header().stamp_ns()};
  if (is_complete_ && status.order_number() != 0)
    add_witness({status.order_number(), status.client()}, robot, witness);
  HeldFlag& flag = held_[robot];
  const std::uint64_t message = status.header().message_number();
  if (std::pair(witness.incarnation, message) < std::pair(flag.incarnation, flag.message)) return;
  const bool was_set = flag.is_set && flag.incarnation == witness.incarnation;
  flag.incarnation = witness.incarnation;
  flag.message = message;
  flag.is_set = status.is_held();
  if (was_set == flag.is_set) return;
  if (flag.is_set && flag.cause && !flag.has_several_causes && is_complete_)
    add_witness(*flag.cause, robot, witness);
  flag.cause.reset();
  flag.has_several_causes = false;
}

void OrderAudit::on_registration(const msg::Registration& registration) {
  AgentRegistration& latest = registered_[registration.robot()];
  const std::int64_t stamp_ns = registration.header().stamp_ns();
  const bool is_repeated =
      latest.epoch == registration.epoch() && latest.incarnation == registration.header().incarnation();
  // The agent had received all orders before its first registration.
  if (registration.epoch() < latest.epoch || (is_repeated && stamp_ns >= latest.stamp_ns)) return;
  latest = {registration.header().incarnation(), registration.epoch(), stamp_ns};
}

void OrderAudit::on_grant(const msg::Verdict& verdict, std::int64_t earliest_ns) {
  Coordinator* const coordinator = coordinator_of(verdict.header());
  if (!coordinator) return;
  const std::int64_t stamp_ns = verdict.header().stamp_ns();
  Grant& latest = coordinator->grants[verdict.robot()];
  if (stamp_ns > latest.stamp_ns && verdict.granted_version() > latest.version)
    latest = {stamp_ns, earliest_ns == kAlways ? stamp_ns : earliest_ns, verdict.granted_version(),
              verdict.epoch()};
  if (verdict.epoch() <= coordinator->epoch) return;
  coordinator->epoch = verdict.epoch();
  coordinator->granting_since_ns = stamp_ns;
}

void OrderAudit::add_witness(const Key& key, RobotId robot, const Witness& witness) {
  const auto [known, is_new] = witnesses_[key].try_emplace(robot, witness);
  if (!is_new && known->second.incarnation < witness.incarnation) known->second = witness;
  bound(witnesses_);
}

void OrderAudit::on_agent_memory(const msg::OrderMemory& memory) {
  const RobotId robot = memory.process();
  if (!is_complete_ || !std::ranges::binary_search(roster_, robot) || memory.header().sender() != robot)
    return;
  for (std::size_t i = 0; i < std::min<std::size_t>(memory.order_count(), memory.orders().size()); ++i) {
    const msg::RememberedOrder& order = memory.orders()[i];
    add_witness({order.terms().order_number(), order.client()}, robot,
                {memory.header().incarnation(), memory.header().stamp_ns()});
  }
}

void OrderAudit::on_memory(const msg::OrderMemory& memory) {
  Coordinator* const coordinator = coordinator_of(memory.header());
  if (!coordinator) return on_agent_memory(memory);
  const msg::Header& header = memory.header();
  std::vector<Terms> orders;
  for (std::size_t i = 0; i < std::min<std::size_t>(memory.order_count(), memory.orders().size()); ++i) {
    const msg::RememberedOrder& order = memory.orders()[i];
    orders.push_back(terms_of(order.robot(), order.client(), order.terms()));
    if (orders.back().kind != msg::OrderKind::ORDER_HOLD) continue;
    const auto [told, is_new] =
        coordinator->announced_ns.try_emplace({orders.back().number, order.client()}, header.stamp_ns());
    if (!is_new) told->second = std::min(told->second, header.stamp_ns());
  }
  bound(coordinator->announced_ns);
  if (memory.page_count() == 0) return;
  if (memory.page_index() == 0) {
    coordinator->memory.clear();
    coordinator->pages = 0;
    coordinator->first_message = header.message_number();
    coordinator->memory_stamp_ns = header.stamp_ns();
  }
  const bool follows = memory.page_index() == coordinator->pages &&
                       header.message_number() == coordinator->first_message + coordinator->pages;
  if (!follows) return;
  coordinator->memory.insert(coordinator->memory.end(), orders.begin(), orders.end());
  if (++coordinator->pages < memory.page_count()) return;
  judge(header.sender(), *coordinator, memory.is_complete());
  coordinator->pages = 0;
}

void OrderAudit::judge(std::uint32_t sender, Coordinator& coordinator, bool claims_completeness) {
  const Memory memory(coordinator.memory);
  may_miss_resumes_ |= memory.has_many_resumes();
  may_miss_removals_ |= memory.has_many_removals();
  judge_grants(memory, coordinator);
  judge_confirmed(memory, sender, coordinator, claims_completeness);
  std::erase_if(coordinator.announced_ns, [&](const auto& told) {
    const auto stands = [&](const Terms& order) { return Key{order.number, order.client} == told.first; };
    return told.second < coordinator.memory_stamp_ns && std::ranges::none_of(coordinator.memory, stands);
  });
}

// If a coordinator announces a hold, grants, and then announces the hold again, it has granted while the hold
// was in force: a lifted hold does not return.
void OrderAudit::judge_grants(const Memory& memory, Coordinator& coordinator) {
  for (const auto& [subject, hold] : memory.orders()) {
    if (hold.kind != msg::OrderKind::ORDER_HOLD) continue;
    const auto told = coordinator.announced_ns.find({hold.number, hold.client});
    if (told == coordinator.announced_ns.end()) continue;
    const bool is_for_all = hold.robot == msg::ALL_ROBOTS;
    if (is_for_all && may_miss_resumes_) continue;
    for (auto grant = coordinator.grants.begin(); grant != coordinator.grants.end();) {
      const auto& [robot, granted] = *grant;
      const bool was_held =
          (is_for_all ? memory.last_resume(hold.client, robot) <= hold.number : hold.robot == robot) &&
          granted.earliest_ns > told->second && granted.stamp_ns < coordinator.memory_stamp_ns;
      if (!was_held) {
        ++grant;
        continue;
      }
      report_(AuditRule::kHeld, robot, granted.version, granted.epoch,
              fmt::format("was granted {:.3f} s after the coordinator had announced hold {} of {}, which "
                          "is still in force",
                          static_cast<double>(granted.stamp_ns - told->second) * 1e-9, hold.number,
                          client_phrase(hold.client, hold.client_name)));
      grant = coordinator.grants.erase(grant);
    }
  }
}

void OrderAudit::judge_confirmed(const Memory& memory, std::uint32_t sender, const Coordinator& coordinator,
                                 bool claims_completeness) {
  std::erase_if(confirmed_, [&](const auto& entry) {
    const Confirmed& confirmed = entry.second;
    const bool is_own = confirmed.coordinator == sender && confirmed.incarnation == coordinator.incarnation &&
                        confirmed.stamp_ns < coordinator.memory_stamp_ns;
    const bool is_granting = claims_completeness && coordinator.epoch != 0 &&
                             coordinator.granting_since_ns < coordinator.memory_stamp_ns;
    if (!is_own && !(is_granting && has_witness(confirmed.terms, coordinator.epoch))) return false;
    const Terms& order = confirmed.terms;
    const SubjectKind matter = std::get<SubjectKind>(order.subject);
    const bool may_be_forgotten = matter == SubjectKind::kZone ? may_miss_removals_
                                  : matter == SubjectKind::kHold || matter == SubjectKind::kResume
                                      ? may_miss_resumes_
                                      : false;
    if (may_be_forgotten) return false;
    if (memory.accounts_for(order)) return false;
    report_(AuditRule::kForgottenOrder, order.robot == msg::ALL_ROBOTS ? roster_.front() : order.robot, 0,
            coordinator.epoch,
            fmt::format("{} {} of {}, confirmed by coordinator {}, is not in the memory of "
                        "coordinator {}, and nothing has replaced it",
                        name_of(order.kind), order.number, client_phrase(order.client, order.client_name),
                        confirmed.coordinator - static_cast<std::uint32_t>(Sender::kCoordinator),
                        sender - static_cast<std::uint32_t>(Sender::kCoordinator)));
    return true;
  });
}

bool OrderAudit::has_witness(const Terms& terms, Epoch epoch) const {
  const auto witnesses = witnesses_.find({terms.number, terms.client});
  if (witnesses == witnesses_.end()) return false;
  return std::ranges::any_of(witnesses->second, [&](const auto& entry) {
    const auto registered = registered_.find(entry.first);
    return registered != registered_.end() && registered->second.epoch == epoch &&
           registered->second.incarnation == entry.second.incarnation &&
           registered->second.stamp_ns > entry.second.stamp_ns &&
           stamps_.are_in_order(entry.first, entry.second.incarnation);
  });
}

}  // namespace sidestep
