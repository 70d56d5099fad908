// SPDX-License-Identifier: Apache-2.0
#include "deploy/sim_system.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "agents/agent/agent_node.hpp"
#include "coordinator/coordinator_node.hpp"
#include "simulator/simulator_node.hpp"
#include "vision/vision_node.hpp"

namespace sidestep {
namespace {

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr Duration kLook = std::chrono::milliseconds(10);
constexpr Duration kSettle = std::chrono::milliseconds(500);

}  // namespace

/// Members go in reverse order: the node before its bus, so that nothing calls back into a node that is gone.
struct SimSystem::Process {
  explicit Process(SimNetwork& network) : bus(network) {}
  SimBus bus;
  std::shared_ptr<void> node;
};

SimSystem::SimSystem(const Scenario& scenario, std::uint64_t seed)
    : scenario_(scenario),
      seed_(seed),
      rng_(seed),
      begin_(kBegin),
      network_(seed, kBegin, scenario.network),
      judge_(scenario_),
      judge_bus_(network_) {
  judge_bus_.subscribe<msg::GroundTruth>(topics::kTruth, [this](const auto& truth) {
    judge_.on_truth(truth);
    if (truth_watcher_) truth_watcher_(truth);
  });
  judge_bus_.subscribe<msg::AgentStatus>(topics::kStatus,
                                         [this](const auto& status) { judge_.on_status(status); });
  judge_bus_.subscribe<msg::CoordinatorState>(topics::kCoordinator,
                                              [this](const auto& state) { judge_.on_coordinator(state); });
  for (const char* process : {"simulator", "vision"}) start(process);
  for (int number = 0; number < scenario_.coordinators; ++number) start(coordinator_process(number));
  for (const RobotSpec& robot : scenario_.robots) start(agent_process(robot.id));
}

SimSystem::~SimSystem() = default;

void SimSystem::start(const std::string& name) {
  auto process = std::make_unique<Process>(network_);
  // Its randomness comes from its incarnation, so that has to come from the seed.
  last_incarnation_ = std::max(last_incarnation_ + 1,
                               static_cast<Incarnation>(to_ns(network_.now())) + rng_.below(1'000'000));
  const Incarnation incarnation = last_incarnation_;
  SimBus& bus = process->bus;
  if (name == "simulator")
    process->node = std::make_shared<SimulatorNode>(bus, scenario_, incarnation, seed_);
  else if (name == "vision")
    process->node = std::make_shared<VisionNode>(bus, scenario_, incarnation);
  for (int number = 0; number < scenario_.coordinators; ++number) {
    if (name != coordinator_process(number)) continue;
    const CoordinatorIdentity self{static_cast<CoordinatorNumber>(number), incarnation};
    process->node = std::make_shared<CoordinatorNode>(bus, scenario_, self, scenario_.coordinators > 1);
  }
  for (const RobotSpec& robot : scenario_.robots) {
    if (name == agent_process(robot.id)) {
      process->node = std::make_shared<AgentNode>(bus, scenario_, robot.id, incarnation);
    }
  }
  if (!process->node) throw std::invalid_argument("the system has no process \"" + name + "\"");
  processes_[name] = std::move(process);
}

void SimSystem::kill(const std::string& process) {
  if (processes_.erase(process) > 0) judge_.on_death(process, "signal 9 (SIGKILL)", now(), false);
}

void SimSystem::restart(const std::string& process) {
  if (!is_alive(process)) start(process);
}

bool SimSystem::run_until_arrived(Time limit) {
  while (now() < limit) {
    run_for(std::min(kLook, limit - now()));
    if (!judge_.all_arrived())
      arrived_since_.reset();
    else if (!arrived_since_)
      arrived_since_ = now();
    if (arrived_since_ && now() - *arrived_since_ >= kSettle) return true;
  }
  return false;
}

}  // namespace sidestep
