// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent_node.hpp"

#include <algorithm>
#include <chrono>

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

AgentNode::AgentNode(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation)
    : bus_(bus),
      robot_(robot),
      cycle_(scenario.cycle),
      agent_(scenario, robot, incarnation),
      command_writer_(bus.advertise(topics::kCommand, robot)),
      registration_writer_(bus.advertise(topics::kRegistration)),
      proposal_writer_(bus.advertise(topics::kProposal)),
      status_writer_(bus.advertise(topics::kStatus)) {
  bus_.subscribe(topics::kFeedback, robot, std::function([this](const msg::Feedback& feedback) {
                   agent_.on_feedback(feedback);
                   register_if_due();
                   if (agent_.negotiation().is_contradicted()) negotiate_if_time();
                 }));
  bus_.subscribe(topics::kVerdict, robot, std::function([this](const msg::Verdict& v) { on_verdict(v); }));
  bus_.subscribe(topics::kWorld,
                 std::function([this](const msg::WorldState& w) { agent_.on_world(w, bus_.now()); }));
  bus_.subscribe(topics::kLedger,
                 std::function([this](const msg::LedgerPage& page) { agent_.on_ledger(page); }));
  bus_.subscribe(topics::kCoordinator,
                 std::function([this](const msg::CoordinatorState& state) { on_coordinator_state(state); }));
  const Time now = bus_.now();
  next_cycle_ = now - now.time_since_epoch() % cycle_ + phase_of(scenario, robot) + cycle_;
  bus_.at(next_cycle_, [this] { begin_cycle(); });
  publish_status();
}

void AgentNode::begin_cycle() {
  const Time now = bus_.now();
  if (next_cycle_ <= now) next_cycle_ += cycle_ * ((now - next_cycle_) / cycle_ + 1);
  bus_.at(next_cycle_, [this] { begin_cycle(); });
  agent_.negotiation().close_cycle(now);
  if (agent_.negotiation().is_superseded()) return;
  if (!commanded_) {
    auto command = agent_.command(now);
    publish(command_writer_, command);
  }
  commanded_ = false;
  if (registration_wait_ > 0) --registration_wait_;
  register_if_due();
  if (!agent_.negotiation().is_fenced()) return;
  if (!agent_.negotiation().is_settled_after(now)) {
    negotiate(next_start());
  } else if (const auto start = agent_.negotiation().unanswered_start(now)) {
    negotiate(*start);
  }
}

void AgentNode::on_coordinator_state(const msg::CoordinatorState& state) {
  const Negotiation& negotiation = agent_.negotiation();
  const Epoch before = negotiation.epoch();
  const bool could_propose = negotiation.may_propose(bus_.now());
  agent_.on_coordinator_state(state, bus_.now());
  if (negotiation.is_superseded()) return;
  // News of a coordinator goes on at once: robots stand still until all have heard of it.
  if (negotiation.epoch() != before) {
    auto command = agent_.command(bus_.now());
    publish(command_writer_, command);
  }
  register_if_due();
  if (!could_propose && negotiation.may_propose(bus_.now()) && !negotiation.is_settled_after(bus_.now())) {
    negotiate_if_time();
  }
}

void AgentNode::register_if_due() {
  if (!agent_.negotiation().needs_registration()) {
    registration_wait_ = 0;
  } else if (registration_wait_ == 0) {
    registration_wait_ = kCyclesBetweenRegistrations;
    auto registration = agent_.negotiation().registration();
    publish(registration_writer_, registration);
  }
}

void AgentNode::negotiate_if_time() {
  if (next_cycle_ - bus_.now() > cycle_ / 4) negotiate(next_start());
}

Time AgentNode::next_start() { return next_cycle_ + cycle_ * (agent_.negotiation().lead() - 1); }

void AgentNode::negotiate(Time start) {
  const auto query = timed(plan_, [&] { return agent_.plan(bus_.now(), start); });
  if (!query) return;
  auto proposal = timed(search_, [&] { return agent_.search(*query, bus_.now()); });
  if (proposal) publish(proposal_writer_, *proposal);
}

void AgentNode::on_verdict(const msg::Verdict& verdict) {
  const auto& counts = agent_.negotiation().counts();
  const auto answered = [&] { return counts.grants + counts.denials; };
  const auto before = answered();
  auto command = agent_.on_verdict(verdict, bus_.now());
  if (answered() != before) negotiation_.add(agent_.negotiation().last_round_trip());
  if (!command) return;
  commanded_ = true;
  publish(command_writer_, *command);
}

void AgentNode::publish_status() {
  bus_.at(bus_.now() + kStatusPeriod, [this] { publish_status(); });
  auto status = agent_.status(bus_.now());
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
