// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/fault_sampler.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "deploy/trial/simulate/campaign/scene_sampler.hpp"
#include "deploy/trial/simulate/campaign/trial.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::fault_sampler_test {

using namespace std::chrono_literals;

TEST_CASE("random scenes have the specified sizes and densities and differ from each other") {
  std::set<std::string> seen;
  std::size_t min_robots = 100, max_robots = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Scenario scenario = sample_scene(rng);  // throws if it is invalid
    const std::size_t count = scenario.robots.size();
    min_robots = std::min(min_robots, count);
    max_robots = std::max(max_robots, count);
    CHECK(count >= 5);
    CHECK(count <= 30);
    const double each_m2 = scenario.field.length_m * scenario.field.width_m / static_cast<double>(count);
    CHECK(each_m2 >= 0.49);
    CHECK(each_m2 <= 3.01);
    CHECK(std::ranges::all_of(scenario.robots, [](const RobotSpec& r) { return r.goals.size() == 150; }));
    CHECK(seen.insert(scene_summary(scenario)).second);
  }
  CHECK(min_robots == 5);
  CHECK(max_robots == 30);
}

TEST_CASE("random disturbances include robots that are power-cycled while being carried") {
  int restarts = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    std::map<RobotId, std::vector<msg::DisturbanceKind>> kinds;
    std::set<RobotId> placed;
    const Trial trial = sample_trial(seed, 60s, std::nullopt);
    for (const TimedFault& timed : trial.plan.faults) {
      if (const auto* disturbance = std::get_if<RobotDisturbance>(&timed.fault))
        kinds[disturbance->robot].push_back(disturbance->kind);
      if (const auto* place = std::get_if<Place>(&timed.fault)) placed.insert(place->robot);
    }
    for (const auto& [robot, sequence] : kinds) {
      const auto lifted = std::ranges::find(sequence, msg::DisturbanceKind::DISTURBANCE_LIFT);
      const auto on = std::find(lifted, sequence.end(), msg::DisturbanceKind::DISTURBANCE_SWITCH_ON);
      if (on == sequence.end()) continue;
      ++restarts;
      CHECK(std::find(lifted, on, msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF) != on);
      CHECK(placed.contains(robot));
    }
  }
  CHECK(restarts >= 5);
}

TEST_CASE("random faults stay within their bounds, include every kind, and end before the fault-free end") {
  std::map<std::size_t, int> kinds;
  int one_way = 0, two_way = 0, lasting = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    const Trial trial = sample_trial(seed, 60s, std::nullopt);
    const FaultPlan& plan = trial.plan;
    CHECK(plan.healed_at == Duration{48s});
    CHECK(std::ranges::is_sorted(plan.faults, {}, &TimedFault::at));
    std::map<std::string, bool> is_alive;
    for (const std::string& process : system_process_names(trial.scenario)) is_alive[process] = true;
    for (const TimedFault& timed : plan.faults) {
      CHECK(timed.at >= Duration{0});
      CHECK(timed.at < plan.healed_at);
      ++kinds[timed.fault.index()];
      if (const auto* change = std::get_if<LinkChange>(&timed.fault)) {
        CHECK(change->quality.loss <= 0.3);
        CHECK(change->quality.delay_max <= Duration{150ms});
        CHECK(change->quality.delay_min <= change->quality.delay_mean);
      } else if (const auto* partition = std::get_if<Partition>(&timed.fault)) {
        lasting += !timed.duration;
        if (!timed.duration) continue;
        CHECK(timed.at + *timed.duration <= plan.healed_at);
        const bool goes_back = std::ranges::any_of(plan.faults, [&](const TimedFault& other) {
          const auto* back = std::get_if<Partition>(&other.fault);
          return back && other.at == timed.at && back->from == partition->to && back->to == partition->from;
        });
        ++(goes_back ? two_way : one_way);
      } else if (std::holds_alternative<Pause>(timed.fault)) {
        CHECK(timed.at + timed.duration.value() <= plan.healed_at);
        CHECK(timed.duration.value() <= Duration{5s});
      } else if (const auto* kill = std::get_if<Kill>(&timed.fault)) {
        is_alive[kill->process] = false;
      } else if (const auto* start = std::get_if<Start>(&timed.fault)) {
        is_alive[start->process] = true;
      }
    }
    for (const auto& [process, alive] : is_alive) {
      CAPTURE(process);
      const bool has_twin = std::ranges::any_of(is_alive, [&](const auto& other) {
        return other.second && other.first.starts_with(process + " (");
      });
      CHECK((alive || has_twin || process.ends_with(")")));
    }
    CHECK(to_lines(plan).size() > plan.faults.size());
  }
  CHECK(kinds.size() == std::variant_size_v<Fault>);
  for (const auto& [kind, count] : kinds) {
    CAPTURE(kind, count);
    CHECK(count >= 10);
  }
  CHECK(lasting >= 10);
  CHECK(one_way > 50);
  CHECK(two_way > 50);
}

TEST_CASE("every kind of fault occurs in a sensible share of the trials, and some trials have no faults") {
  constexpr int kTrials = 400;
  std::map<std::string, int> trials;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    for (const std::string& kind : sample_trial(seed, 60s, std::nullopt).fault_kinds()) ++trials[kind];
    CHECK(sample_trial(seed, 60s, std::nullopt, false).plan.faults.empty());
  }
  for (const char* const kind : {"push",
                                 "slip",
                                 "block",
                                 "reboot",
                                 "forget pose",
                                 "lift",
                                 "place",
                                 "switch off",
                                 "switch on",
                                 "take away",
                                 "carry",
                                 "clock step",
                                 "clock drift",
                                 "clock out of bound",
                                 "other rules",
                                 "forgery",
                                 "opponents",
                                 "people in a building",
                                 "seen beside",
                                 "seen as",
                                 "seen frozen",
                                 "ghost robots",
                                 "ghost obstacles",
                                 "lasers",
                                 "lasting cut",
                                 "process clock step",
                                 "robots with lead"}) {
    CAPTURE(kind, trials[kind]);
    CHECK(trials[kind] >= 0.03 * kTrials);
    CHECK(trials[kind] <= 0.25 * kTrials);
  }
  for (const char* const kind :
       {"simulation not in real time", "simulation in steps", "cameras that disagree"}) {
    CAPTURE(kind, trials[kind]);
    CHECK(trials[kind] >= 0.01 * kTrials);
  }
  for (const char* const kind :
       {"order to go", "cancellation", "hold", "hold of all robots", "resume", "zone", "removal of a zone"}) {
    CAPTURE(kind, trials[kind]);
    CHECK(trials[kind] >= 0.1 * kTrials);
    CHECK(trials[kind] <= 0.6 * kTrials);
  }
}

TEST_CASE("a robot's clock is either within every coordinator's bound or listed and far beyond the bound") {
  int with_clocks = 0, beyond = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    const Trial trial = sample_trial(seed, 60s, std::nullopt);
    const auto& clocks = trial.plan.clocks;
    with_clocks += !clocks.empty();
    const std::vector<RobotId> out_of_bound = robots_with(trial.plan, RobotEnd::kClockOutOfBound);
    beyond += !out_of_bound.empty();
    for (const RobotSpec& robot : trial.scenario.robots) {
      const Duration robot_s =
          robot.clock_offset + (clocks.empty() ? Duration{0} : clocks.at("simulator").offset);
      for (int number = 0; number < trial.scenario.coordinators && !clocks.empty(); ++number) {
        const Duration difference = std::chrono::abs(robot_s - clocks.at(coordinator_process(number)).offset);
        const bool is_off = std::ranges::find(out_of_bound, robot.id) != out_of_bound.end();
        CAPTURE(robot.id, number, to_seconds(difference));
        CHECK((is_off ? difference > Duration{300ms}
                      : difference < from_seconds(trial.scenario.clock_bound_s)));
      }
    }
  }
  CHECK(with_clocks > 150);
  CHECK(beyond > 15);
  CHECK(beyond < 60);
}

TEST_CASE("the same seed gives the same trial, and the scene does not depend on the duration") {
  const Trial a = sample_trial(5, 60s, std::nullopt), b = sample_trial(5, 60s, std::nullopt),
              shorter = sample_trial(5, 20s, std::nullopt), other = sample_trial(6, 60s, std::nullopt);
  CHECK(to_lines(a.plan) == to_lines(b.plan));
  CHECK(scene_summary(a.scenario) == scene_summary(shorter.scenario));
  CHECK(scene_summary(a.scenario) != scene_summary(other.scenario));
}

}  // namespace sidestep::fault_sampler_test
