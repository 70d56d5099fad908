// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/launched_faults.hpp"

#include <algorithm>
#include <csignal>
#include <fmt/format.h>
#include <iterator>
#include <stdexcept>

#include "common/protocol/process_names.hpp"
#include "deploy/trial/fault/fault_target.hpp"
#include "deploy/trial/fault/network_message.hpp"
#include "deploy/trial/fault/operator_messages.hpp"
#include "deploy/trial/simulate/system/system_processes.hpp"
#include "deploy/trial/test/runs/active_coordinator.hpp"

namespace sidestep {
namespace {

void require_subscriber(const OperatorChannel& channel, const std::string& participant) {
  const auto subscribers = without_observers(channel.subscribers());
  if (subscribers.empty() ||
      (!participant.empty() && std::ranges::find(subscribers, participant) == subscribers.end()))
    throw std::runtime_error((participant.empty() ? "no process" : participant) +
                             " does not receive these faults");
}

}  // namespace

LaunchedFaults::LaunchedFaults(const FaultTest& test, const RunHosts& hosts, const DdsSettings& dds,
                               Launcher& launcher, const RunObserver& observer)
    : test_(test),
      hosts_(hosts),
      launcher_(launcher),
      observer_(observer),
      attestations_(observer, [this](msg::AbsenceAttestation& attestation) {
        attestation.header(operator_header());
        absences_->writer().write(&attestation);
      }) {
  for (const PlannedFault& fault : test.faults) require_possible(fault);
  DdsSettings settings = dds;
  settings.participant = "sidestep-fault";
  if (has_fault<RobotDisturbance>(test)) {
    disturbance_channel_.emplace(settings, topics::kDisturbance);
    disturbances_.emplace(launcher.bus(), disturbance_channel_->writer());
  }
  if (has_fault<ImpairmentFault>(test)) network_faults_.emplace(settings, topics::kNetworkFault);
  if (has_fault<AbsenceFault>(test)) absences_.emplace(settings, topics::kAttestation);
  if (has_fault<Partition>(test)) partitions_.emplace(test, hosts);
}

void LaunchedFaults::require_possible(const PlannedFault& fault) const {
  if (const auto* kill = std::get_if<Kill>(&fault.action)) require_local(kill->process, fault.text);
  if (const auto* pause = std::get_if<Pause>(&fault.action)) {
    for (const std::string& process : pause->processes) require_local(process, fault.text);
  }
  if (const auto* restart = std::get_if<RestartFault>(&fault.action))
    require_local(restart->process, fault.text);
}

void LaunchedFaults::require_local(const std::string& process, const std::string& text) const {
  const auto require = [&](const std::string& name) {
    if (hosts_.placement().host_of(name).transport == HostTransport::kSsh)
      throw std::runtime_error(text + " is impossible over ssh");
  };
  if (process == kActiveCoordinator) {
    for (int number = 0; number < test_.scenario.coordinators; ++number) require(coordinator_process(number));
    return;
  }
  for (const RobotSpec& robot : test_.scenario.robots) {
    if (process == twin_process(robot.id)) return require(agent_process(robot.id));
  }
  require(process);
}

void LaunchedFaults::begin(std::size_t fault) {
  std::visit([&](const auto& action) { apply(action, fault); }, test_.faults[fault].action);
}

void LaunchedFaults::end(std::size_t fault) {
  const FaultAction& action = test_.faults[fault].action;
  if (const auto* partition = std::get_if<Partition>(&action)) partitions_->end(*partition);
  if (const auto* impairment = std::get_if<ImpairmentFault>(&action))
    impair(impairment->target, kUnimpairedLink, 0);
  // A paused process may have been killed in the meantime.
  for (const std::string& process : paused_[fault]) (void)launcher_.send_signal(process, SIGCONT);
}

std::vector<FaultProblem> LaunchedFaults::problems() {
  std::vector<FaultProblem> all = disturbances_ ? disturbances_->problems() : std::vector<FaultProblem>();
  std::ranges::copy(attestations_.problems(), std::back_inserter(all));
  return all;
}

void LaunchedFaults::send_signal(const std::string& process, int signal) {
  if (!launcher_.send_signal(process, signal)) throw std::runtime_error(process + " is not running");
}

void LaunchedFaults::impair(const std::string& target, const LinkQuality& quality, std::uint64_t seed) {
  msg::NetworkFault fault = encode(quality, parse_fault_target(target)->number, seed);
  fault.header(operator_header());
  network_faults_->writer().write(&fault);
}

void LaunchedFaults::apply(const Kill& fault, std::size_t) {
  send_signal(resolved(fault.process, observer_.history()), SIGKILL);
}

void LaunchedFaults::apply(const RestartFault& fault, std::size_t) {
  launcher_.restart(fault.process, fault.scenario_file.empty() ? test_.file : fault.scenario_file);
}

void LaunchedFaults::apply(const Pause& fault, std::size_t index) {
  for (const std::string& name : fault.processes) {
    const std::string process = resolved(name, observer_.history());
    send_signal(process, SIGSTOP);
    paused_[index].push_back(process);
  }
}

void LaunchedFaults::apply(const Partition& fault, std::size_t) { partitions_->begin(fault); }

void LaunchedFaults::apply(const ImpairmentFault& fault, std::size_t index) {
  require_subscriber(*network_faults_, parse_fault_target(fault.target)->participant);
  impair(fault.target, fault.quality, index + 1);
}

void LaunchedFaults::apply(const RobotDisturbance& fault, std::size_t index) {
  require_subscriber(*disturbance_channel_, "sidestep-simulator");
  // The robot's agent must request the rest version at this position.
  if (fault.kind == msg::DisturbanceKind::DISTURBANCE_PLACE)
    require_subscriber(*disturbance_channel_, fmt::format("agent-{}", fault.robot));
  disturbances_->begin(fault, test_.faults[index]);
}

void LaunchedFaults::apply(const TwinFault& fault, std::size_t) {
  launcher_.start_twin(fault.robot, twin_process(fault.robot));
}

void LaunchedFaults::apply(const AbsenceFault& fault, std::size_t) {
  attestations_.begin(fault.robot, launcher_.bus().now());
}

}  // namespace sidestep
