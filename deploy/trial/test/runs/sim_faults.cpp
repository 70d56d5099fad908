// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/sim_faults.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/trial/test/runs/active_coordinator.hpp"

namespace sidestep {
namespace {

// Approximate time that the launcher takes to restart a process.
constexpr Duration kRestartDelay = std::chrono::milliseconds(200);

/// The probability that at least one of two independent events happens.
double either(double a, double b) { return 1 - (1 - a) * (1 - b); }

LinkQuality impaired(const NetworkSpec& network, const LinkQuality& fault) {
  LinkQuality quality = fault;
  quality.loss = either(network.loss, fault.loss);
  quality.duplicate = either(network.duplicate, fault.duplicate);
  quality.delay_min += network.delay_min;
  quality.delay_mean += (network.delay_min + network.delay_max) / 2;
  quality.delay_max += network.delay_max;
  return quality;
}

bool is_restarted(const std::string& process, const RestartSpec& restart) {
  if (process.ends_with(" (twin)")) return false;
  if (process.starts_with("agent ")) return restart.agents;
  if (process.starts_with("coordinator")) return restart.coordinator;
  return process == "vision" && restart.vision;
}

}  // namespace

SimFaults::SimFaults(const FaultTest& test, SimSystem& system, Bus& bus, const RunObserver& observer)
    : test_(test),
      system_(system),
      observer_(observer),
      links_(system, impaired(test.scenario.network, kUnimpairedLink)),
      disturbance_writer_(bus.relay(topics::kDisturbance, topics::kDisturbance.name)),
      disturbances_(bus, *disturbance_writer_),
      attestation_writer_(bus.advertise(topics::kAttestation)),
      attestations_(observer, [this](msg::AbsenceAttestation& attestation) {
        attestation.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
        attestation_writer_.publish(attestation, system_.now());
      }) {}

void SimFaults::begin(std::size_t fault) {
  const PlannedFault& planned = test_.faults[fault];
  std::visit([&](const auto& action) { apply(action, planned); }, planned.action);
}

void SimFaults::end(std::size_t fault) {
  const FaultAction& action = test_.faults[fault].action;
  if (const auto* partition = std::get_if<Partition>(&action)) links_.end(*partition);
  if (const auto* impairment = std::get_if<ImpairmentFault>(&action))
    impair(impairment->target, kUnimpairedLink);
}

std::vector<FaultProblem> SimFaults::problems() {
  std::vector<FaultProblem> all = disturbances_.problems();
  std::ranges::copy(attestations_.problems(), std::back_inserter(all));
  return all;
}

Time SimFaults::next() const {
  Time earliest = Time::max();
  for (const auto& [process, at] : restarts_) earliest = std::min(earliest, at);
  return earliest;
}

void SimFaults::update() {
  std::erase_if(restarts_, [this](const auto& restart) {
    if (restart.second > system_.now()) return false;
    system_.restart(restart.first);
    return true;
  });
  attestations_.update(system_.now());
}

std::string SimFaults::running(const std::string& process) const {
  const std::string name = resolved(process, observer_.history());
  if (!system_.is_alive(name)) throw std::runtime_error(name + " is not running");
  return name;
}

void SimFaults::apply(const Kill& fault, const PlannedFault&) {
  const std::string process = running(fault.process);
  system_.kill(process);
  end_impairment(process);
  if (is_restarted(process, test_.scenario.restart)) restarts_[process] = system_.now() + kRestartDelay;
}

void SimFaults::apply(const RestartFault& fault, const PlannedFault&) {
  system_.kill(fault.process);
  end_impairment(fault.process);
  restarts_.erase(fault.process);
  if (!fault.scenario_file.empty()) {
    system_.use_scenario(fault.process, load_scenario(fault.scenario_file));
    with_changed_rules_.insert(fault.process);
  } else if (with_changed_rules_.erase(fault.process) > 0) {
    system_.use_scenario(fault.process, test_.scenario);
  }
  system_.restart(fault.process);
}

void SimFaults::apply(const Pause& fault, const PlannedFault& planned) {
  for (const std::string& process : fault.processes)
    system_.pause(running(process), from_seconds(planned.seconds.value()), fault.max_queued);
}

void SimFaults::impair(const std::string& target, const LinkQuality& quality) {
  ProcessNames processes = system_process_names(test_.scenario);
  for (const RobotSpec& robot : test_.scenario.robots) processes.push_back(twin_process(robot.id));
  const LinkQuality link = impaired(test_.scenario.network, quality);
  for (const std::string& to : processes) {
    if (target != "all" && target != to) continue;
    impaired_.insert(to);
    for (const std::string& from : processes) {
      if (from != to) links_.set_quality(from, to, link);
    }
  }
}

void SimFaults::apply(const TwinFault& fault, const PlannedFault&) {
  system_.restart(twin_process(fault.robot));
}

void SimFaults::apply(const AbsenceFault& fault, const PlannedFault&) {
  attestations_.begin(fault.robot, system_.now());
}

}  // namespace sidestep
