// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/fault_player.hpp"

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/campaign/trial.hpp"
#include "tests/catch.hpp"

namespace sidestep::fault_player_test {

using namespace std::chrono_literals;

Scenario pair_of_robots() {
  return parse_scenario(
      "field: {length_m: 6, width_m: 4}\nlimits: {speed_mps: 0.3}\ncircle: {count: 2, spacing_m: 3}\n",
      "pair.yaml");
}

FaultPlan plan_of(const Scenario& scenario, std::vector<TimedFault> faults, Duration healed_at) {
  FaultPlan plan;
  for (const std::string& process : system_process_names(scenario)) plan.hosts.push_back({process});
  plan.faults = std::move(faults);
  plan.healed_at = healed_at;
  return plan;
}

/// Counts the verdicts that the agent of robot 0 receives.
struct Verdicts {
  explicit Verdicts(SimSystem& system) : bus(system.network()) {
    bus.become_observer();
    bus.subscribe(topics::kStatus, std::function([this](const msg::AgentStatus& status) {
                    if (status.robot() == 0) answered = status.grants() + status.denials();
                  }));
  }
  SimBus bus;
  std::uint64_t answered = 0;
};

TEST_CASE("a partition cuts links for its duration, even if two partitions overlap") {
  const Scenario scenario = pair_of_robots();
  const Partition partition{{"coordinator"}, {"agent 0"}};
  const FaultPlan plan = plan_of(scenario, {{1s, partition, 2s}, {2500ms, partition, 1s}}, 20s);
  SimSystem system(scenario, 1);
  Verdicts verdicts(system);
  FaultPlayer player(system, scenario, plan);
  player.run_until(1250ms);
  const auto before = verdicts.answered;
  CHECK(before > 10);
  // The second partition begins during the first one and ends after it.
  player.run_until(3400ms);
  const auto within = verdicts.answered;
  CHECK(within <= before + 3);
  // Agents that missed verdicts propose less often for some time.
  player.run_until(5500ms);
  CHECK(verdicts.answered > within + 8);
}

TEST_CASE("a killed process stays dead until it is started, and a second agent runs beside the first agent") {
  const Scenario scenario = pair_of_robots();
  FaultPlan plan =
      plan_of(scenario, {{1s, Kill{"vision"}}, {2s, Start{"vision"}}, {3s, Start{twin_process(1)}}}, 20s);
  plan.hosts.push_back({twin_process(1)});
  SimSystem system(scenario, 1);
  FaultPlayer player(system, scenario, plan);
  player.run_until(1500ms);
  CHECK_FALSE(system.is_alive("vision"));
  player.run_until(2500ms);
  CHECK(system.is_alive("vision"));
  CHECK_FALSE(system.is_alive(twin_process(1)));
  player.run_until(3500ms);
  CHECK(system.is_alive(twin_process(1)));
  CHECK(system.is_alive("agent 1"));
}

TEST_CASE("the operator places a robot even if its agent is dead when the first place is requested") {
  const Scenario scenario = pair_of_robots();
  RobotDisturbance lift;
  lift.robot = 1;
  lift.kind = msg::DisturbanceKind::DISTURBANCE_LIFT;
  const FaultPlan plan = plan_of(scenario,
                                 {{1s, lift},
                                  {2s, Kill{"agent 1"}},
                                  {2500ms, Place{1, {Vec2(0.5, 1.5), Vec2(-0.5, -1.5)}, 1}},
                                  {3s, Start{"agent 1"}}},
                                 20s);
  SimSystem system(scenario, 1);
  std::size_t on_floor = 0;
  system.observer_bus().subscribe(topics::kTruth,
                                  [&](const msg::GroundTruth& truth) { on_floor = truth.robots().size(); });
  FaultPlayer player(system, scenario, plan);
  player.run_until(2900ms);
  CHECK(on_floor == 1);
  player.run_until(6s);
  CHECK(on_floor == 2);
}

TEST_CASE("the operator places a robot whose lifting is delayed by a simulator pause") {
  const Scenario scenario = pair_of_robots();
  RobotDisturbance lift;
  lift.robot = 1;
  lift.kind = msg::DisturbanceKind::DISTURBANCE_LIFT;
  const FaultPlan plan = plan_of(
      scenario, {{1s, Pause{{"simulator"}, 1000}, 3s}, {1100ms, lift}, {2s, Place{1, {Vec2(0.5, 1.5)}, 1}}},
      20s);
  SimSystem system(scenario, 1);
  std::size_t on_floor = 0;
  system.observer_bus().subscribe(topics::kTruth,
                                  [&](const msg::GroundTruth& truth) { on_floor = truth.robots().size(); });
  FaultPlayer player(system, scenario, plan);
  player.run_until(4100ms);
  CHECK(on_floor == 1);
  player.run_until(8s);
  CHECK(on_floor == 2);
}

TEST_CASE("the operator attests the absence of a robot that was taken away while switched off") {
  const Scenario scenario = pair_of_robots();
  RobotDisturbance off;
  off.robot = 1;
  off.kind = msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF;
  const FaultPlan plan =
      plan_of(scenario,
              {{1s, off}, {2s, TakeAway{1}}, {3s, Kill{"coordinator"}}, {3500ms, Start{"coordinator"}}}, 20s);
  SimSystem system(scenario, 1);
  FaultPlayer player(system, scenario, plan);
  player.run_until(8s);
  CHECK(system.metrics().unregistered_robots().empty());
  CHECK(system.metrics().progress().at(0).agent_state == msg::AgentState::AGENT_DRIVING);
  CHECK(system.metrics().report().audit->violations == 0);
}

TEST_CASE("if all processes that knew orders restart, the operator resumes robots and sends new orders") {
  const Scenario scenario = pair_of_robots();
  std::vector<TimedFault> faults;
  for (const std::string& process : {agent_process(0), agent_process(1), coordinator_process(0)})
    faults.push_back({1s, Kill{process}});
  for (const std::string& process : {agent_process(0), agent_process(1), coordinator_process(0)})
    faults.push_back({2s, Start{process}});
  const FaultPlan plan = plan_of(scenario, faults, 10s);
  SimSystem system(scenario, 1);
  FaultPlayer player(system, scenario, plan);
  const auto are_all = [&](msg::AgentState state) {
    return std::ranges::all_of(system.metrics().progress(),
                               [&](const RobotProgress& row) { return row.agent_state == state; });
  };
  player.run_until(9s);
  CHECK(are_all(msg::AgentState::AGENT_HELD));
  player.run_until(13s);
  CHECK(are_all(msg::AgentState::AGENT_DRIVING));
}

TEST_CASE("when all faults end, link qualities recover and partitions end") {
  const Scenario scenario = pair_of_robots();
  LinkQuality terrible;
  terrible.loss = 1;
  const auto processes = system_process_names(scenario);
  const FaultPlan plan = plan_of(
      scenario,
      {{0s, LinkChange{processes, processes, terrible}}, {1s, Partition{processes, processes}, 30s}}, 3s);
  SimSystem system(scenario, 1);
  Verdicts verdicts(system);
  FaultPlayer player(system, scenario, plan);
  player.run_until(3s);
  CHECK(verdicts.answered == 0);
  player.run_until(5s);
  CHECK(verdicts.answered > 10);
}

TEST_CASE("the description of a plan says who gives an order") {
  FaultPlan plan;
  plan.healed_at = 3s;
  plan.add(1s, GiveOrder{{msg::OrderKind::ORDER_HOLD, 3, static_cast<ClientId>(Sender::kOperator)}});
  plan.add(2s, GiveOrder{{msg::OrderKind::ORDER_RESUME, kAllRobots, 1'000'001}});
  CHECK(to_lines(plan) ==
        std::vector<std::string>{"one host per process", "1.000 s: the operator holds robot 3",
                                 "2.000 s: client 1000001 resumes all robots", "3.000 s: end of all faults"});
}

TEST_CASE("the same seed gives the same trial result and a different seed a different result") {
  const auto outcome = [](std::uint64_t seed) {
    Report report;
    run_trial(sample_trial(seed, 10s, std::nullopt), &report);
    report.plan = report.search = DurationHistogram{};
    return to_json(report);
  };
  CHECK(outcome(17) == outcome(17));
  CHECK(outcome(17) != outcome(18));
}

TEST_CASE("the report of a trial in which a process accepted a second simulator counts no audit violations") {
  const std::string second = second_process("simulator");
  const Scenario scenario = pair_of_robots();
  Trial trial{1, scenario, plan_of(scenario, {}, 6s), 10s};
  trial.plan.hosts.push_back({second});
  const bool is_first_silent = GENERATE(false, true);
  CAPTURE(is_first_silent);
  if (is_first_silent) trial.plan.faults.push_back({1s, Pause{{"simulator"}, 1000}, 3s});
  trial.plan.faults.push_back({2s, Start{second}});
  Report report;
  CHECK(run_trial(trial, &report).is_audited == !is_first_silent);
  CHECK((report.audit->exemption == "a process accepted a second simulator") == is_first_silent);
  if (is_first_silent) CHECK(report.audit->verdict() == AuditVerdict::kNotJudged);
}

TEST_CASE("a system that never starts to drive is reported as stuck") {
  const Scenario scenario = pair_of_robots();
  Trial trial{1, scenario, plan_of(scenario, {{0s, Kill{"coordinator"}}}, 1s), 10s};
  const TrialResult dead = run_trial(trial);
  REQUIRE(dead.failures.size() == 4);
  CHECK_THAT(dead.failures[0], ContainsSubstring("the audit did not judge the run"));
  CHECK(dead.failures[1] == "no coordinator ever granted");
  CHECK_THAT(dead.failures[2], ContainsSubstring("robots 0, 1 do not drive"));
  CHECK_THAT(dead.failures[3], ContainsSubstring("no robot moves"));
  CHECK(dead.distance_after_recovery_m == 0);
  trial.plan.faults.clear();
  const TrialResult alive = run_trial(trial);
  CHECK(alive.failures.empty());
  // The distance after recovery covers the time from three to ten seconds.
  CHECK(alive.distance_after_recovery_m > 0.5 * alive.distance_m);
  CHECK(alive.distance_after_recovery_m < 0.9 * alive.distance_m);
}

}  // namespace sidestep::fault_player_test
