// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/agent_node.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/messaging/histogram_codec.hpp"

namespace sidestep {
namespace {

constexpr Duration kStatusPeriod{200'000'000};
constexpr int kCyclesBetweenRegistrations = 3;

/// Offset of the robot's cycles from multiples of the cycle time.
Duration cycle_offset(const Scenario& scenario, RobotId robot) {
  const auto index = std::ranges::count_if(scenario.robots, [&](const RobotSpec& r) { return r.id < robot; });
  return scenario.cycle * index / static_cast<std::int64_t>(scenario.robots.size());
}

/// Adds the duration of `work` to a histogram. It is measured by the wall clock even if the bus's time is
/// virtual.
template <typename Work>
auto timed(DurationHistogram& histogram, Work work) {
  const auto begin = std::chrono::steady_clock::now();
  auto result = work();
  histogram.add(std::chrono::steady_clock::now() - begin);
  return result;
}

}  // namespace

AgentNode::AgentNode(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation,
                     std::shared_ptr<PlanningScratch> scratch, const PlanningSettings& settings)
    : bus_(bus),
      robot_(robot),
      cycle_(scenario.cycle),
      agent_(scenario, robot, incarnation, std::move(scratch), settings),
      clocks_(robot, from_seconds(scenario.clock_bound_s)),
      command_writer_(bus.advertise(topics::kCommand, robot)),
      registration_writer_(bus.advertise(topics::kRegistration)),
      proposal_writer_(bus.advertise(topics::kProposal)),
      status_writer_(bus.advertise(topics::kStatus)) {
  bus_.subscribe(topics::kFeedback, robot, [this](const msg::Feedback& feedback) {
    measure_robot_clock(feedback);
    const bool is_contradicted = agent_.on_feedback(feedback);
    register_if_due();
    if (is_contradicted) negotiate_if_time();
  });
  bus_.subscribe(topics::kVerdict, robot, [this](const msg::Verdict& v) { on_verdict(v); });
  bus_.subscribe(topics::kWorld, [this](const msg::WorldState& w) {
    agent_.on_world(w, bus_.now() + clocks_.max_robot_offset(bus_.now()));
  });
  bus_.subscribe(topics::kDisturbance, [this](const msg::Disturbance& d) { agent_.on_disturbance(d); });
  bus_.subscribe(topics::kLedger,
                 [this](const msg::LedgerPage& page) { agent_.on_ledger(page, bus_.attachment(&page)); });
  bus_.subscribe(topics::kCoordinator,
                 [this](const msg::CoordinatorState& state) { on_coordinator_state(state); });
  const Time now = robot_now();
  next_cycle_ = now - now.time_since_epoch() % cycle_ + cycle_offset(scenario, robot) + cycle_;
  schedule_next_cycle();
  publish_status();
}

void AgentNode::begin_cycle() {
  // The estimate of the robot's clock may have changed slightly since the timer was set.
  const Duration early = next_cycle_ - robot_now();
  const Time now = early > Duration{0} && early < cycle_ / 2 ? next_cycle_ : robot_now();
  next_cycle_ = cycle_after(now);
  schedule_next_cycle();
  agent_.close_cycle(now);
  if (agent_.is_superseded()) {
    if (const auto callback = std::exchange(on_superseded_, nullptr)) callback();
    return;
  }
  if (!commanded_) publish_command(now);
  commanded_ = false;
  if (registration_wait_ > 0) --registration_wait_;
  if (measurement_wait_ > 0) --measurement_wait_;
  register_if_due();
  if (const auto start = agent_.start_to_propose(now, next_cycle_)) negotiate(*start);
}

Time AgentNode::robot_now() const { return bus_.now() + clocks_.robot_offset(); }

Time AgentNode::cycle_after(Time now) const {
  const Duration elapsed = (now - next_cycle_) % cycle_;
  return now - elapsed + (elapsed < Duration{0} ? Duration{0} : cycle_);
}

void AgentNode::measure_robot_clock(const msg::Feedback& feedback) {
  clocks_.on_feedback(feedback, agent_.incarnation(), bus_.now());
  // The robot's clock estimate jumped: reschedule the next cycle.
  const Duration until_cycle = next_cycle_ - robot_now();
  if (until_cycle > 2 * cycle_ || until_cycle < -2 * cycle_) next_cycle_ = cycle_after(robot_now());
}

void AgentNode::schedule_next_cycle() {
  bus_.at(next_cycle_ - clocks_.robot_offset(), [this] { begin_cycle(); });
}

void AgentNode::on_coordinator_state(const msg::CoordinatorState& state) {
  const Epoch last_epoch = agent_.epoch();
  const bool could_propose = agent_.may_propose(robot_now());
  agent_.on_coordinator_state(state, robot_now());
  if (agent_.is_superseded()) return;
  // A new epoch is forwarded immediately, because no robot moves until all have acknowledged it.
  if (agent_.epoch() != last_epoch) publish_command(robot_now());
  register_if_due();
  if (!could_propose && agent_.may_propose(robot_now()) && !agent_.has_upcoming_version(robot_now()))
    negotiate_if_time();
}

void AgentNode::register_if_due() {
  if (!agent_.needs_registration()) {
    registration_wait_ = 0;
  } else if (registration_wait_ == 0) {
    registration_wait_ = kCyclesBetweenRegistrations;
    publish_registration();
  }
}

bool AgentNode::clocks_agree() {
  clocks_.on_epoch(agent_.epoch());
  if (clocks_.is_measurement_due(bus_.now()) && measurement_wait_ == 0) {
    measurement_wait_ = kCyclesBetweenRegistrations;
    publish_registration();
  }
  return clocks_.allows_motion(bus_.now());
}

void AgentNode::negotiate_if_time() {
  if (next_cycle_ - robot_now() > cycle_ / 4) negotiate(agent_.earliest_start(next_cycle_));
}

void AgentNode::negotiate(Time start) {
  if (!agent_.may_propose(robot_now()) || !clocks_agree()) return;
  if (agent_.needs_rest_version(robot_now())) {
    publish_proposal(agent_.propose_rest_version(robot_now(), start));
    return;
  }
  const auto plan = timed(plan_durations_, [&] { return agent_.plan(robot_now(), start); });
  if (!plan) return;
  auto proposal = timed(search_durations_, [&] { return agent_.search(*plan, robot_now()); });
  if (proposal) publish_proposal(std::move(*proposal));
}

void AgentNode::on_verdict(const msg::Verdict& verdict) {
  clocks_.on_epoch(agent_.epoch());
  clocks_.on_verdict(verdict, bus_.now());
  auto result = agent_.on_verdict(verdict, robot_now());
  if (result.round_trip) negotiation_durations_.add(*result.round_trip);
  if (!result.command) return;
  commanded_ = true;
  publish(command_writer_, *result.command);
}

void AgentNode::publish_command(Time now) {
  auto command = agent_.command(now);
  publish(command_writer_, command);
}

void AgentNode::publish_registration() {
  auto registration = agent_.registration();
  publish(registration_writer_, registration);
  clocks_.on_request_sent(time_from_ns(registration.header().stamp_ns()));
}

void AgentNode::publish_proposal(msg::Proposal proposal) {
  publish(proposal_writer_, proposal);
  clocks_.on_request_sent(time_from_ns(proposal.header().stamp_ns()));
}

void AgentNode::publish_status() {
  bus_.at(bus_.now() + kStatusPeriod, [this] { publish_status(); });
  if (agent_.is_superseded()) return;
  auto status = agent_.status(robot_now());
  clocks_.fill(status, bus_.now());
  status.negotiation(encode(negotiation_durations_));
  status.plan(encode(plan_durations_));
  status.search(encode(search_durations_));
  publish(status_writer_, status);
}

template <typename Message>
void AgentNode::publish(Writer<Message>& writer, Message& message) {
  message.header().sender(robot_);
  message.header().incarnation(agent_.incarnation());
  writer.publish(message, bus_.now());
}

}  // namespace sidestep
