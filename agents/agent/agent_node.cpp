// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent_node.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace sidestep {
namespace {

constexpr Duration kStatusPeriod{200'000'000};
constexpr int kCyclesBetweenRegistrations = 3;

/// Where in the cycle a robot's own cycle begins.
Duration phase_of(const Scenario& scenario, RobotId robot) {
  const auto before =
      std::ranges::count_if(scenario.robots, [&](const RobotSpec& r) { return r.id < robot; });
  return scenario.cycle * before / static_cast<std::int64_t>(scenario.robots.size());
}

/// Adds the time that `work` takes; this is measured on the wall even when time is virtual.
template <typename Work>
auto timed(DurationHistogram& histogram, Work work) {
  const auto begin = std::chrono::steady_clock::now();
  auto result = work();
  histogram.add(std::chrono::steady_clock::now() - begin);
  return result;
}

}  // namespace

AgentNode::AgentNode(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation,
                     std::shared_ptr<PlanningScratch> bench)
    : bus_(bus),
      robot_(robot),
      cycle_(scenario.cycle),
      agent_(scenario, robot, incarnation, std::move(bench)),
      clocks_(robot, from_seconds(scenario.clock_bound_s)),
      command_writer_(bus.advertise(topics::kCommand, robot)),
      registration_writer_(bus.advertise(topics::kRegistration)),
      proposal_writer_(bus.advertise(topics::kProposal)),
      status_writer_(bus.advertise(topics::kStatus)) {
  bus_.subscribe(topics::kFeedback, robot, [this](const msg::Feedback& feedback) {
    measure_robot_clock(feedback);
    agent_.on_feedback(feedback);
    register_if_due();
    if (agent_.negotiation().is_contradicted()) negotiate_if_time();
  });
  bus_.subscribe(topics::kVerdict, robot, [this](const msg::Verdict& v) { on_verdict(v); });
  bus_.subscribe(topics::kWorld, [this](const msg::WorldState& w) {
    agent_.on_world(w, bus_.now() + clocks_.robot_ahead_at_most(bus_.now()));
  });
  bus_.subscribe(topics::kDisturbance, [this](const msg::Disturbance& hand) { agent_.on_disturbance(hand); });
  bus_.subscribe(topics::kLedger,
                 [this](const msg::LedgerPage& page) { agent_.on_ledger(page, bus_.beside(&page)); });
  bus_.subscribe(topics::kCoordinator,
                 [this](const msg::CoordinatorState& state) { on_coordinator_state(state); });
  const Time now = robot_now();
  next_cycle_ = now - now.time_since_epoch() % cycle_ + phase_of(scenario, robot) + cycle_;
  begin_next_cycle_later();
  publish_status();
}

void AgentNode::begin_cycle() {
  // The timer was set by what was known of the robot's clock then.
  const Duration early = next_cycle_ - robot_now();
  const Time now = early > Duration{0} && early < cycle_ / 2 ? next_cycle_ : robot_now();
  next_cycle_ = cycle_after(now);
  begin_next_cycle_later();
  agent_.negotiation().close_cycle(now);
  if (agent_.negotiation().is_superseded()) {
    if (const auto callback = std::exchange(on_superseded_, nullptr)) callback();
    return;
  }
  if (!commanded_) {
    auto command = agent_.command(now);
    publish(command_writer_, command);
  }
  commanded_ = false;
  if (registration_wait_ > 0) --registration_wait_;
  if (measurement_wait_ > 0) --measurement_wait_;
  register_if_due();
  if (!agent_.negotiation().is_fenced()) return;
  if (!agent_.negotiation().is_settled_after(now)) {
    negotiate(next_start());
  } else if (const auto start = agent_.negotiation().unanswered_start(now)) {
    negotiate(*start);
  }
}

Time AgentNode::robot_now() const { return bus_.now() + clocks_.robot_ahead(); }

Time AgentNode::cycle_after(Time now) const {
  const Duration into = (now - next_cycle_) % cycle_;
  return now - into + (into < Duration{0} ? Duration{0} : cycle_);
}

void AgentNode::measure_robot_clock(const msg::Feedback& feedback) {
  clocks_.on_feedback(feedback, agent_.negotiation().incarnation(), bus_.now());
  // Its clock is another than was believed: what was the next cycle by the old belief is far away.
  const Duration away = next_cycle_ - robot_now();
  if (away > 2 * cycle_ || away < -2 * cycle_) next_cycle_ = cycle_after(robot_now());
}

void AgentNode::begin_next_cycle_later() {
  bus_.at(next_cycle_ - clocks_.robot_ahead(), [this] { begin_cycle(); });
}

void AgentNode::on_coordinator_state(const msg::CoordinatorState& state) {
  const Negotiation& negotiation = agent_.negotiation();
  const Epoch before = negotiation.epoch();
  const bool could_propose = negotiation.may_propose(robot_now());
  agent_.on_coordinator_state(state, robot_now());
  if (negotiation.is_superseded()) return;
  // News of a coordinator goes on at once: robots stand still until all have heard of it.
  if (negotiation.epoch() != before) {
    auto command = agent_.command(robot_now());
    publish(command_writer_, command);
  }
  register_if_due();
  if (!could_propose && negotiation.may_propose(robot_now()) && !negotiation.is_settled_after(robot_now())) {
    negotiate_if_time();
  }
}

void AgentNode::register_if_due() {
  if (!agent_.negotiation().needs_registration()) {
    registration_wait_ = 0;
  } else if (registration_wait_ == 0) {
    registration_wait_ = kCyclesBetweenRegistrations;
    publish_registration();
  }
}

void AgentNode::publish_registration() {
  auto registration = agent_.negotiation().registration();
  publish(registration_writer_, registration);
  clocks_.on_asked(time_from_ns(registration.head().stamp_ns()));
}

bool AgentNode::clocks_agree() {
  clocks_.on_epoch(agent_.negotiation().epoch());
  if (clocks_.is_measurement_due(bus_.now()) && measurement_wait_ == 0) {
    measurement_wait_ = kCyclesBetweenRegistrations;
    publish_registration();
  }
  return clocks_.allows_motion(bus_.now());
}

void AgentNode::negotiate_if_time() {
  if (next_cycle_ - robot_now() > cycle_ / 4) negotiate(next_start());
}

Time AgentNode::next_start() { return next_cycle_ + cycle_ * (agent_.negotiation().lead() - 1); }

void AgentNode::negotiate(Time start) {
  if (!agent_.negotiation().may_propose(robot_now()) || !clocks_agree()) return;
  if (agent_.wants_stand(robot_now())) {
    auto stand = agent_.propose_stand(robot_now(), start);
    return ask(stand);
  }
  const auto query = timed(plan_, [&] { return agent_.plan(robot_now(), start); });
  if (!query) return;
  if (auto proposal = timed(search_, [&] { return agent_.search(*query, robot_now()); })) ask(*proposal);
}

void AgentNode::ask(msg::Proposal& proposal) {
  publish(proposal_writer_, proposal);
  clocks_.on_asked(time_from_ns(proposal.head().stamp_ns()));
}

void AgentNode::on_verdict(const msg::Verdict& verdict) {
  const auto& counts = agent_.negotiation().counts();
  const auto answered = [&] { return counts.grants + counts.denials; };
  const auto before = answered();
  clocks_.on_epoch(agent_.negotiation().epoch());
  clocks_.on_verdict(verdict, bus_.now());
  auto command = agent_.on_verdict(verdict, robot_now());
  if (answered() != before) negotiation_.add(agent_.negotiation().last_round_trip());
  if (!command) return;
  commanded_ = true;
  publish(command_writer_, *command);
}

void AgentNode::publish_status() {
  bus_.at(bus_.now() + kStatusPeriod, [this] { publish_status(); });
  if (agent_.negotiation().is_superseded()) return;
  auto status = agent_.status(robot_now());
  clocks_.fill(status, bus_.now());
  negotiation_.to_message(status.negotiation());
  plan_.to_message(status.plan());
  search_.to_message(status.search());
  publish(status_writer_, status);
}

template <typename Message>
void AgentNode::publish(Writer<Message>& writer, Message& message) {
  message.head().sender(robot_);
  message.head().incarnation(agent_.negotiation().incarnation());
  writer.publish(message, bus_.now());
}

}  // namespace sidestep
