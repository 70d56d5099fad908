// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/system/sim_system.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "agents/agent/agent_node.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/role_watch.hpp"
#include "common/messaging/single_writer_guard.hpp"
#include "common/protocol/senders.hpp"
#include "coordinator/coordinator_node.hpp"
#include "deploy/trial/simulate/system/driven_bases.hpp"
#include "simulator/images/image_output.hpp"
#include "vision/images/image_input.hpp"
#include "vision/images/image_options.hpp"

namespace sidestep {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(10);
constexpr Duration kSettlingTime = std::chrono::milliseconds(500);

/// The nodes of sidestep-simulator.
struct SimulatorProcess {
  SimulatorProcess(Bus& bus, const Scenario& scenario, Incarnation incarnation, std::uint64_t seed)
      : node(bus, scenario, incarnation, seed) {
    if (scenario.vision.images) images.emplace(bus, scenario, node, incarnation, seed);
  }
  void on_event(LogLevel min_level, OnLogEvent callback) { node.on_event(min_level, std::move(callback)); }
  SimulatorNode node;
  std::optional<ImageOutput> images;
};

/// The nodes of sidestep-vision.
struct VisionProcess {
  VisionProcess(Bus& bus, const Scenario& scenario, Incarnation incarnation)
      : node(bus, scenario, incarnation, scenario.vision.images ? FrameSource::kCaller : FrameSource::kBus) {
    if (scenario.vision.images) images.emplace(bus, image_reader(scenario, {}), node);
  }
  void on_event(LogLevel min_level, OnLogEvent callback) { node.on_event(min_level, std::move(callback)); }
  VisionNode node;
  std::optional<ImageInput> images;
};

}  // namespace

/// The id of a process that is not an agent.
std::uint32_t id_of(const std::string& process, const Scenario& scenario) {
  const std::string name = first_process(process);
  const auto id = process_id(name);
  if (!id || std::ranges::count(system_process_names(scenario), name) == 0)
    throw std::invalid_argument("the system has no process \"" + name + "\"");
  return *id;
}

/// Members are destroyed in reverse order: the node before its bus, so the bus never calls a destroyed node.
struct SimSystem::Process {
  Process(SimNetwork& network, const SimProcessSpec& spec, std::uint32_t id, const SharedRules& shared)
      : bus(network, spec),
        rules(bus, id, shared, [this](const RulesMismatch& m) { report(LogLevel::kWarning, describe(m)); }) {
    bus.watch_conflicts([this](const TopicInfo& topic, std::uint32_t robot, const msg::Header& header) {
      report(LogLevel::kError, describe_conflict(topic, robot, header));
    });
  }
  void report(LogLevel level, const std::string& text) const {
    if (on_event && level >= reported_level) on_event({level, {}, text});
  }
  template <typename Node>
  void run(std::shared_ptr<Node> new_node) {
    listen = [&target = *new_node](LogLevel min_level, OnLogEvent callback) {
      target.on_event(min_level, std::move(callback));
    };
    node = std::move(new_node);
  }

  SimBus bus;
  OnLogEvent on_event;
  LogLevel reported_level = LogLevel::kOff;
  RulesExchange rules;
  std::optional<RoleWatch> role;
  std::shared_ptr<void> node;
  DrivenBases* bases = nullptr;                      // the node, if it is that
  std::function<void(LogLevel, OnLogEvent)> listen;  // sets the callback for the node's events
};

SimSystem::SimSystem(const Scenario& scenario, std::uint64_t seed, std::map<std::string, ClockError> clocks,
                     Time begin, const std::optional<DrivenBaseSettings>& bases)
    : scenario_(scenario),
      seed_(seed),
      rng_(seed),
      clocks_(std::move(clocks)),
      begin_(begin),
      bases_(bases),
      scratch_(std::make_shared<PlanningScratch>(scenario_)),
      network_(seed, begin, scenario.network),
      metrics_(scenario_),
      auditor_(scenario_, {true, {}}),
      observer_(network_.new_process()),
      observer_bus_(network_, {observer_}),
      rules_(observer_bus_, static_cast<std::uint32_t>(Sender::kOperator), SharedRules(scenario_),
             [this](const RulesMismatch& mismatch) { metrics_.on_mismatch(mismatch); }),
      disturbance_writer_(observer_bus_.advertise(topics::kDisturbance)),
      order_writer_(observer_bus_.advertise(topics::kOrder)) {
  for (auto& [process, clock] : clocks_) clock.since = begin_;
  observer_bus_.become_observer();
  observer_bus_.trust_first_senders();
  watch_second_simulators(observer_bus_);
  metrics_.set_auditor(auditor_);
  listen(observer_bus_, scenario_, auditor_);
  observer_bus_.subscribe<msg::GroundTruth>(topics::kTruth,
                                            [this](const auto& truth) { metrics_.on_truth(truth); });
  observer_bus_.subscribe<msg::AgentStatus>(topics::kStatus,
                                            [this](const auto& status) { metrics_.on_status(status); });
  observer_bus_.subscribe<msg::OrderStatus>(topics::kOrderStatus,
                                            [this](const auto& status) { metrics_.on_order_status(status); });
  observer_bus_.subscribe<msg::CoordinatorState>(
      topics::kCoordinator, [this](const auto& state) { metrics_.on_coordinator(state); });
  observer_bus_.subscribe<msg::Counters>(topics::kCounters,
                                         [this](const auto& counters) { metrics_.on_counters(counters); });
  metrics_.set_bus(observer_bus_);
  for (const RobotSpec& robot : scenario_.robots)
    robot_of_[agent_process(robot.id)] = robot_of_[twin_process(robot.id)] = robot.id;
  for (const std::string& process : system_process_names(scenario_)) start(process);
}

SimSystem::~SimSystem() = default;

SimProcessSpec SimSystem::spec_of(const std::string& process) {
  const auto known = ids_.find(process);
  const ProcessId id = known != ids_.end() ? known->second : network_.new_process();
  ids_[process] = id;
  const auto clock = clocks_.find(process);
  return clock == clocks_.end() ? SimProcessSpec{id} : SimProcessSpec{id, clock->second};
}

void SimSystem::start(const std::string& name) {
  const auto agent = robot_of_.find(name);
  const std::uint32_t id = agent != robot_of_.end() ? agent->second : id_of(name, scenario_);
  const auto other = scenarios_.find(name);
  const Scenario& scenario = other != scenarios_.end() ? other->second : scenario_;
  auto process = std::make_unique<Process>(network_, spec_of(name), id, SharedRules(scenario));
  SimBus& bus = process->bus;
  watch_second_simulators(bus);
  if (now() > begin_) bus.listen_before_trusting();
  // As over DDS, the incarnation is the process's clock reading. It seeds the process's random numbers, so it
  // must depend on the seed.
  Incarnation& incarnation = incarnations_[name];
  incarnation = std::max(incarnation + 1, static_cast<Incarnation>(to_ns(bus.now())) + rng_.below(1'000'000));
  if (name == second_process("simulator")) second_simulators_.push_back(incarnation);
  process->role.emplace(bus, id, incarnation, [this, name, id, own = incarnation](Incarnation found) {
    on_other(name, id, own, found);
  });
  if (agent != robot_of_.end()) {
    const auto scratch = &scenario == &scenario_ ? scratch_ : std::make_shared<PlanningScratch>(scenario);
    process->run(std::make_shared<AgentNode>(bus, scenario, id, incarnation, scratch));
  } else if (first_process(name) == "simulator" && bases_) {
    auto bases = std::make_shared<DrivenBases>(bus, scenario, *bases_, incarnation, seed_);
    process->bases = bases.get();
    process->run(std::move(bases));
  } else if (first_process(name) == "simulator") {
    process->run(std::make_shared<SimulatorProcess>(bus, scenario, incarnation, seed_));
  } else if (first_process(name) == "vision") {
    process->run(std::make_shared<VisionProcess>(bus, scenario, incarnation));
  } else {
    const CoordinatorIdentity self{id - static_cast<std::uint32_t>(Sender::kCoordinator), incarnation};
    process->run(std::make_shared<CoordinatorNode>(bus, scenario, self, scenario.coordinators > 1));
  }
  processes_[name] = std::move(process);
  started_at_[name] = now();
  observe(name);
}

void SimSystem::watch_second_simulators(SimBus& bus) {
  bus.watch_headers([this](const TopicInfo& topic, const msg::Header& header) {
    // A simulator's robots use its incarnation, and raise it when their clocks are set back.
    const auto is_of = [&](Incarnation second) {
      return header.incarnation() >= second && header.incarnation() - second <= SingleWriterGuard::kMaxRaise;
    };
    if (topic.is_single_writer && std::ranges::any_of(second_simulators_, is_of))
      was_second_simulator_accepted_ = true;
  });
}

void SimSystem::on_other(const std::string& name, std::uint32_t id, Incarnation own, Incarnation other) {
  processes_.at(name)->report(LogLevel::kError, describe_other(id, own, other));
  if (keeps_duplicates_running_ || !must_be_alone(id) || own < other) return;
  // The process is not destroyed immediately, because this is a callback of its own bus.
  observer_bus_.at(now(), [this, name] { processes_.erase(name); });
}

void SimSystem::observe(const std::string& name) {
  if (!on_event_) return;
  Process& process = *processes_.at(name);
  process.reported_level = min_level_;
  process.on_event = [this, name](const LogEvent& event) { on_event_(name, event); };
  process.listen(min_level_, process.on_event);
}

void SimSystem::on_event(LogLevel min_level, OnProcessEvent callback) {
  min_level_ = min_level;
  on_event_ = std::move(callback);
  for (const auto& [name, process] : processes_) observe(name);
}

void SimSystem::kill(const std::string& process) {
  if (processes_.erase(process) > 0) metrics_.on_death(process, "signal 9 (SIGKILL)", now(), false);
}

void SimSystem::place(RobotId robot, const Vec2& position_m, double heading_rad) {
  processes_.at("simulator")->bases->place(robot, position_m, heading_rad);
}

void SimSystem::pause(const std::string& process, Duration duration, std::size_t max_queued) {
  const auto found = processes_.find(process);
  if (found != processes_.end()) found->second->bus.pause(now() + duration, max_queued);
}

void SimSystem::send(const Order& order) {
  auto message = encode(order);
  order_writer_.publish(message, now());
}

void SimSystem::set_clock(const std::string& process, Duration offset) {
  const ClockError clock{offset, clocks_[process].drift_ppm, now()};
  clocks_[process] = clock;
  const auto found = processes_.find(process);
  if (found != processes_.end()) found->second->bus.set_clock(clock);
}

void SimSystem::set_link(const std::string& from, const std::string& to, const LinkQuality& quality) {
  network_.set_link(spec_of(from).process, spec_of(to).process, quality);
}

void SimSystem::set_client_link(const std::string& to, const LinkQuality& quality) {
  network_.set_link(observer_, spec_of(to).process, quality);
}

void SimSystem::restart(const std::string& process) {
  if (!is_alive(process)) start(process);
}

bool SimSystem::run_until_arrived(Time limit) {
  while (now() < limit) {
    run_for(std::min(kStep, limit - now()));
    if (!metrics_.all_arrived())
      arrived_since_.reset();
    else if (!arrived_since_)
      arrived_since_ = now();
    if (arrived_since_ && now() - *arrived_since_ >= kSettlingTime) return true;
  }
  return false;
}

}  // namespace sidestep
