// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/event_watch.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

#include "common/messaging/blockage_text.hpp"
#include "common/messaging/disturbance_answer.hpp"
#include "common/messaging/enumerator.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/refusal_text.hpp"
#include "common/protocol/client_text.hpp"
#include "common/protocol/disturbance_text.hpp"
#include "common/protocol/process_names.hpp"
#include "common/protocol/role_cause.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

/// Maximum number of remembered senders, because a hostile participant can invent senders.
constexpr std::size_t kMaxSenders = 1000;

std::string who(std::uint32_t robot) {
  return robot == msg::ALL_ROBOTS ? std::string("all robots") : fmt::format("robot {}", robot);
}

std::vector<RobotId> robots_of(std::uint32_t robot) {
  return robot < kMaxRobots ? std::vector<RobotId>{robot} : std::vector<RobotId>{};
}

}  // namespace

void EventWatch::add(Severity severity, std::string kind, std::string text, Time at,
                     std::vector<RobotId> robots) {
  log_.add({0, at, severity, std::move(kind), std::move(text), std::move(robots)});
}

bool EventWatch::store_if_changed(Watched what, std::uint32_t id, std::uint64_t value, std::uint64_t normal) {
  const auto [last, is_new] = last_.try_emplace({what, id}, normal);
  if (last->second == value) return false;
  last->second = value;
  return true;
}

bool EventWatch::store_order(const msg::Order& order) {
  const ClientId sender = order.header().sender();
  if (sent_orders_.size() >= kMaxSenders && !sent_orders_.contains(sender)) sent_orders_.clear();
  SentOrder& last = sent_orders_[sender];
  last.name = is_name_of(order.terms().client_name(), sender) ? order.terms().client_name() : ClientName{};
  return std::exchange(last.number, order.terms().order_number()) != order.terms().order_number();
}

std::string EventWatch::phrase_of(ClientId client) const {
  const auto known = sent_orders_.find(client);
  return client_phrase(client, known == sent_orders_.end() ? ClientName{} : known->second.name);
}

void EventWatch::on(const msg::GroundTruth& truth, Time now) {
  const TruthTotals totals{truth.header().incarnation(), truth.contacts(), truth.crashes_while_moving(),
                           truth.firmware_violations()};
  const TruthTotals last =
      totals_ && totals_->incarnation == totals.incarnation ? *totals_ : TruthTotals{totals.incarnation};
  totals_ = totals;
  const auto first_known = [](std::uint64_t before, std::uint64_t count) {
    return std::max(before, count - std::min<std::uint64_t>(count, msg::MAX_CONTACTS));
  };
  for (std::uint64_t i = first_known(last.contacts, totals.contacts); i < totals.contacts; ++i) {
    const msg::ContactPair& pair = truth.recent_contacts()[i % msg::MAX_CONTACTS];
    if (pair.second() == msg::NO_ROBOT)
      add(Severity::kError, "contact", fmt::format("robot {} touches an obstacle", pair.first()), now,
          robots_of(pair.first()));
    else
      add(Severity::kError, "contact", fmt::format("robots {} and {} touch", pair.first(), pair.second()),
          now, {pair.first(), pair.second()});
  }
  for (std::uint64_t i = first_known(last.crashes, totals.crashes); i < totals.crashes; ++i) {
    const std::uint32_t robot = truth.recent_moving_crashes()[i % msg::MAX_CONTACTS];
    add(Severity::kError, "crash", fmt::format("robot {} touches a person or opponent while it moves", robot),
        now, robots_of(robot));
  }
  if (totals.violations > last.violations)
    add(Severity::kError, "firmware",
        fmt::format("{} violations of the robots' own rules", totals.violations - last.violations), now);
}

void EventWatch::on(const msg::Feedback& feedback, Time now) {
  const std::uint32_t robot = feedback.robot();
  if (robot >= kMaxRobots) return;
  if (store_if_changed(Watched::kOffReference, robot, feedback.is_off_reference())) {
    feedback.is_off_reference()
        ? add(Severity::kWarning, "off reference",
              fmt::format("robot {} lost its reference and stops by itself", robot), now, {robot})
        : add(Severity::kInfo, "on reference", fmt::format("robot {} is on its reference again", robot), now,
              {robot});
  }
  if (store_if_changed(Watched::kLifted, robot, feedback.is_lifted()))
    add(Severity::kInfo, feedback.is_lifted() ? "lifted" : "placed",
        fmt::format("robot {} is {} the floor", robot, feedback.is_lifted() ? "off" : "on"), now, {robot});
}

void EventWatch::on(const msg::AgentStatus& status, Time now) {
  const std::uint32_t robot = status.robot();
  if (robot >= kMaxRobots) return;
  const std::uint64_t incarnation = status.header().incarnation();
  const auto agent = last_.find({Watched::kAgent, robot});
  if (agent != last_.end() && agent->second < incarnation)
    add(Severity::kWarning, "restart", fmt::format("agent {} has started again", robot), now, {robot});
  if (agent == last_.end() || agent->second < incarnation) last_[{Watched::kAgent, robot}] = incarnation;
  const auto state = static_cast<std::uint64_t>(status.agent_state());
  if (!store_if_changed(Watched::kAgentState, robot, state)) return;
  if (status.agent_state() == msg::AgentState::AGENT_ARRIVED)
    add(Severity::kInfo, "arrived", fmt::format("robot {} has arrived", robot), now, {robot});
  if (status.agent_state() == msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND)
    add(Severity::kError, "clock",
        fmt::format("robot {} is stopped: its clock differs by more than the scenario allows", robot), now,
        {robot});
}

void EventWatch::on(const msg::OrderStatus& status, Time now) {
  const std::uint32_t robot = status.robot();
  if (robot >= kMaxRobots) return;
  if (store_if_changed(Watched::kHeld, robot, status.is_held()))
    add(Severity::kInfo, status.is_held() ? "hold" : "resume",
        fmt::format("robot {} is {}", robot, status.is_held() ? "held" : "released"), now, {robot});
  const auto report = decode(status);
  const bool is_blocked = report && report->blockage;
  if (!store_if_changed(Watched::kOrder, robot, is_blocked)) return;
  is_blocked
      ? add(Severity::kWarning, "blocked",
            fmt::format("robot {} is blocked: {}", robot, to_text(*report->blockage)), now, {robot})
      : add(Severity::kInfo, "free", fmt::format("robot {} is no longer blocked", robot), now, {robot});
}

void EventWatch::on(const msg::CoordinatorState& state, Time now) {
  const std::uint32_t number = state.coordinator();
  if (number >= kMaxCoordinators) return;
  const auto mode = static_cast<std::uint64_t>(state.coordinator_mode());
  if (store_if_changed(Watched::kCoordinator, number, state.epoch() << 2 | (mode & 3))) {
    constexpr std::array kModes{"stands by", "asks all robots to register", "grants"};
    std::string text = fmt::format("{} {} in epoch {}", coordinator_process(static_cast<int>(number)),
                                   kModes[std::min<std::size_t>(mode, 2)], state.epoch());
    if (is_enumerator(state.role_reason(), msg::RoleReason::ROLE_SHARED_EPOCH))
      text += ": " + describe(RoleCause{state.role_reason(), state.role_peer(),
                                        Duration(state.role_silence_ns()), state.role_learned_epoch()});
    const bool is_takeover = state.role_reason() == msg::RoleReason::ROLE_HEARTBEATS_LOST;
    add(is_takeover ? Severity::kWarning : Severity::kInfo, "epoch", text, now);
  }
  if (state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_STANDBY) return;
  for (const msg::RobotNotice& notice : state.notices()) {
    if (notice.robot() >= kMaxRobots) continue;
    const unsigned value = (notice.is_quarantined() ? 1u : 0u) | (notice.is_displaced() ? 2u : 0u);
    if (!store_if_changed(Watched::kNotice, notice.robot(), value) || value == 0) continue;
    add(Severity::kError, notice.is_quarantined() ? "quarantined" : "displaced",
        fmt::format("robot {} {}", notice.robot(),
                    notice.is_quarantined() ? "has reported a motion that was never granted"
                                            : "is where none of its motions can have taken it"),
        now, {notice.robot()});
  }
}

void EventWatch::on(const msg::Order& order, Time now) {
  constexpr std::array kTexts{"sends {} to a goal", "cancels the order of {}", "holds {}",
                              "resumes {}",         "sets a zone, for {}",     "removes a zone, for {}"};
  const msg::OrderKind kind = order.terms().order_kind();
  if (!is_enumerator(kind, msg::OrderKind::ORDER_REMOVE_ZONE)) return;
  // A client repeats its order until a coordinator answers.
  if (!store_order(order) || !external_event_limit_.admit(now)) return;
  add(Severity::kInfo, "order",
      phrase_of(order.header().sender()) + " " +
          fmt::format(fmt::runtime(kTexts[static_cast<std::size_t>(kind)]), who(order.robot())),
      now, robots_of(order.robot()));
}

void EventWatch::on(const msg::OrderAnswer& answer, Time now) {
  const msg::OrderResult result = answer.result();
  const bool is_refused =
      result != msg::OrderResult::RESULT_REMEMBERED && result != msg::OrderResult::RESULT_REPLACED;
  if (!is_refused || !is_enumerator(result, msg::OrderResult::RESULT_TOO_MANY) ||
      !external_event_limit_.admit(now))
    return;
  add(Severity::kWarning, "order",
      fmt::format("an order from {} was refused: {}", phrase_of(answer.client()), refusal_text(result)), now);
}

void EventWatch::on(const msg::Disturbance& disturbance, Time now) {
  if (!is_enumerator(disturbance.disturbance_kind(), msg::DisturbanceKind::DISTURBANCE_SEEN_FROZEN) ||
      !external_event_limit_.admit(now))
    return;
  add(Severity::kWarning, "disturbance",
      fmt::format("{} is disturbed: {}", who(disturbance.robot()), to_text(disturbance.disturbance_kind())),
      now, robots_of(disturbance.robot()));
}

void EventWatch::on(const msg::DisturbanceAnswer& answer, Time now) {
  if (answer.result() == msg::DisturbanceResult::FAULT_APPLIED ||
      !is_enumerator(answer.result(), msg::DisturbanceResult::FAULT_NOT_CONFUSABLE) ||
      !external_event_limit_.admit(now))
    return;
  add(Severity::kWarning, "disturbance",
      fmt::format("a disturbance of {} was refused: {}", who(answer.robot()),
                  refusal_text(answer.robot(), answer.result())),
      now, robots_of(answer.robot()));
}

void EventWatch::on(const msg::NetworkFault& fault, Time now) {
  if (!external_event_limit_.admit(now)) return;
  const std::string target =
      fault.target() == kEveryProcess ? std::string("every process") : process_name(fault.target());
  add(Severity::kWarning, "network",
      fault.is_cut() ? fmt::format("no message reaches {}", target)
                     : fmt::format("{:.0f} % of the messages to {} are lost", 100 * fault.loss(), target),
      now, robots_of(fault.target()));
}

void EventWatch::on(const msg::AbsenceAttestation& attestation, Time now) {
  if (!external_event_limit_.admit(now)) return;
  add(Severity::kWarning, "attestation",
      fmt::format("an operator attests that robot {} is not on the floor", attestation.robot()), now,
      robots_of(attestation.robot()));
}

void EventWatch::on_violation(const Violation& violation) {
  std::vector<RobotId> robots{violation.robot};
  if (violation.other) robots.push_back(*violation.other);
  add(Severity::kError, "violation", to_line(violation), violation.detected, std::move(robots));
}

void EventWatch::on_refused(std::uint32_t sender, Time now) {
  if (refused_.contains(sender) || !external_event_limit_.admit(now)) return;
  if (refused_.size() >= kMaxSenders) refused_.clear();
  refused_.insert(sender);
  add(Severity::kError, "rules",
      fmt::format("{} has different rules: its messages are refused", process_name(sender)), now,
      robots_of(sender));
}

void EventWatch::watch_silence(std::uint32_t id, bool is_silent, const std::string& name, bool is_robot,
                               Time now) {
  if (!store_if_changed(Watched::kSilent, id, is_silent)) return;
  const std::vector<RobotId> robots = is_robot ? std::vector<RobotId>{id} : std::vector<RobotId>{};
  is_silent ? add(Severity::kError, "silent", name + " is silent", now, robots)
            : add(Severity::kInfo, "heard", name + " is heard again", now, robots);
}

void EventWatch::tick(const FloorState& floor, Time now) {
  constexpr std::uint32_t kRobotReports = 0x10000;  // keys of robots; agents use the robot's number
  for (const auto& [id, robot] : floor.robots()) {
    if (robot.status) watch_silence(id, now - robot.status->at > kSilence, agent_process(id), true, now);
    if (robot.feedback)
      watch_silence(kRobotReports + id, now - robot.feedback->at > kSilence, fmt::format("robot {}", id),
                    false, now);
  }
  for (const auto& [number, state] : floor.coordinators())
    watch_silence(static_cast<std::uint32_t>(Sender::kCoordinator) + number, now - state.at > kSilence,
                  coordinator_process(static_cast<int>(number)), false, now);
}

}  // namespace sidestep
