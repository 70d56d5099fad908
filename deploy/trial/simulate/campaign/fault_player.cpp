// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/fault_player.hpp"

#include <algorithm>
#include <iterator>

#include "deploy/trial/simulate/campaign/rule_mutations.hpp"

namespace sidestep {
namespace {

using std::chrono::microseconds;

LinkQuality within_host() { return {0, 1, 0, microseconds(30), microseconds(60), microseconds(300), false}; }
LinkQuality between_hosts() {
  return {0, 1, 0, microseconds(200), microseconds(350), microseconds(1000), false};
}

}  // namespace

FaultPlayer::FaultPlayer(SimSystem& system, const Scenario& scenario, const FaultPlan& plan)
    : system_(system),
      scenario_(scenario),
      plan_(plan),
      operator_(system, scenario),
      links_(system, between_hosts()),
      schedule_(plan.faults, system.begin()) {
  for (const TimedFault& timed : plan.faults) {
    const auto* const send = std::get_if<SendForgery>(&timed.fault);
    const auto is_of = [send](const auto& forger) { return forger->victim() == send->victim; };
    if (send && std::ranges::none_of(forgers_, is_of))
      forgers_.push_back(std::make_unique<Forger>(system.network(), scenario, send->victim));
  }
  const auto is_order = [](const TimedFault& timed) {
    return std::holds_alternative<GiveOrder>(timed.fault);
  };
  if (std::ranges::any_of(plan.faults, is_order)) clients_.emplace(system, scenario);
  for (const ProcessNames& host : plan.hosts) {
    for (const std::string& process : host) host_of_[process] = &host;
    std::ranges::copy(host, std::back_inserter(processes_));
  }
  set_qualities(processes_, processes_, between_hosts());
}

void FaultPlayer::set_qualities(const ProcessNames& from, const ProcessNames& to,
                                const LinkQuality& between) {
  for (const std::string& sender : from) {
    for (const std::string& receiver : to) {
      const bool is_within_host = host_of_.at(sender) == host_of_.at(receiver);
      links_.set_quality(sender, receiver, is_within_host ? within_host() : between);
    }
  }
}

void FaultPlayer::begin(std::size_t fault) {
  const TimedFault& timed = plan_.faults[fault];
  std::visit([&](const auto& kind) { apply(kind, timed); }, timed.fault);
}

void FaultPlayer::end(std::size_t fault) {
  if (const auto* partition = std::get_if<Partition>(&plan_.faults[fault].fault)) links_.end(*partition);
}

void FaultPlayer::apply(const Partition& partition, const TimedFault& timed) {
  links_.begin(partition);
  if (timed.duration || !clients_) return;
  for (const std::string& process : partition.to) clients_->stop_judging(process);
}

void FaultPlayer::apply(const Pause& pause, const TimedFault& timed) {
  for (const std::string& process : pause.processes)
    system_.pause(process, timed.duration.value(), pause.max_queued);
}

void FaultPlayer::start_with(const Scenario& scenario, const std::string& process) {
  system_.kill(process);
  system_.use_scenario(process, scenario);
  system_.restart(process);
}

void FaultPlayer::apply(const StartWithMutatedRule& start, const TimedFault&) {
  Scenario other = scenario_;
  rule_mutations()[start.rule].change(other);
  start_with(other, start.process);
}

void FaultPlayer::apply(const SendForgery& send, const TimedFault&) {
  for (const auto& forger : forgers_) {
    if (forger->victim() != send.victim) continue;
    forgeries()[send.forgery].change(*forger);
    forger->send();
  }
}

std::vector<std::string> FaultPlayer::order_failures() const {
  return clients_ ? clients_->failures() : std::vector<std::string>{};
}

void FaultPlayer::advance(Time until) {
  for (;;) {
    const Time next = std::min(until, operator_.due().value_or(until));
    system_.run_until(next);
    operator_.update();
    if (next >= until) return;
  }
}

void FaultPlayer::play(Time until) {
  while (schedule_.next() <= until) {
    advance(schedule_.next());
    schedule_.apply_next(*this);
  }
  advance(until);
}

void FaultPlayer::heal() {
  is_healed_ = true;
  operator_.resume_held_robots();
  while (schedule_.next() < Time::max()) schedule_.apply_next(*this);
  set_qualities(processes_, processes_, between_hosts());
}

void FaultPlayer::run_until(Duration after_begin) {
  if (!is_healed_) play(system_.begin() + std::min(after_begin, plan_.healed_at));
  if (!is_healed_ && plan_.healed_at <= after_begin) heal();
  advance(system_.begin() + after_begin);
}

}  // namespace sidestep
