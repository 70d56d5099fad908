// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/sim_faults.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/trial/test/runs/active_coordinator.hpp"
#include "simulator/world/disturbance_codec.hpp"

namespace sidestep {
namespace {

// About as long as the launcher takes.
constexpr Duration kRestartDelay = std::chrono::milliseconds(200);
// Messages that a paused process can still receive afterwards, as in the buffer of a socket.
constexpr std::size_t kMaxQueued = 1000;

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
      links_(system, test.scenario),
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
  if (const auto* partition = std::get_if<PartitionFault>(&action)) links_.end(*partition);
  if (const auto* impairment = std::get_if<ImpairmentFault>(&action)) links_.end(*impairment);
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
  if (!system_.is_alive(name)) throw std::runtime_error(name + " does not run");
  return name;
}

void SimFaults::apply(const KillFault& fault, const PlannedFault&) {
  const std::string process = running(fault.process);
  system_.kill(process);
  links_.end_impairment(process);
  if (is_restarted(process, test_.scenario.restart)) restarts_[process] = system_.now() + kRestartDelay;
}

void SimFaults::apply(const RestartFault& fault, const PlannedFault&) {
  system_.kill(fault.process);
  links_.end_impairment(fault.process);
  restarts_.erase(fault.process);
  if (!fault.scenario_file.empty()) {
    system_.use_scenario(fault.process, load_scenario(fault.scenario_file));
    with_other_rules_.insert(fault.process);
  } else if (with_other_rules_.erase(fault.process) > 0) {
    system_.use_scenario(fault.process, test_.scenario);
  }
  system_.restart(fault.process);
}

void SimFaults::apply(const PauseFault& fault, const PlannedFault& planned) {
  system_.pause(running(fault.process), from_seconds(planned.seconds.value()), kMaxQueued);
}

void SimFaults::apply(const RobotDisturbance& fault, const PlannedFault&) {
  msg::Disturbance message = encode(fault);
  system_.disturb(message);
}

void SimFaults::apply(const TwinFault& fault, const PlannedFault&) {
  system_.restart(twin_process(fault.robot));
}

void SimFaults::apply(const AbsenceFault& fault, const PlannedFault&) {
  attestations_.begin(fault.robot, system_.now());
}

}  // namespace sidestep
