// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/fault_sampler.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "deploy/simulate/campaign/scene_sampler.hpp"
#include "deploy/simulate/campaign/trial.hpp"
#include "deploy/simulate/system/sim_system.hpp"

using namespace sidestep;
using namespace std::chrono_literals;

TEST_CASE("drawn floors are of the size and density asked for, and no two are alike") {
  std::set<std::string> seen;
  std::size_t fewest = 100, most = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Scenario scenario = sample_scene(rng);  // throws when it is not valid
    const std::size_t count = scenario.robots.size();
    fewest = std::min(fewest, count);
    most = std::max(most, count);
    CHECK(count >= 5);
    CHECK(count <= 30);
    const double each_m2 = scenario.field.length_m * scenario.field.width_m / static_cast<double>(count);
    CHECK(each_m2 >= 0.49);
    CHECK(each_m2 <= 3.01);
    CHECK(std::ranges::all_of(scenario.robots, [](const RobotSpec& r) { return r.goals.size() >= 100; }));
    CHECK(seen.insert(floor_in_words(scenario)).second);
  }
  CHECK(fewest == 5);
  CHECK(most == 30);
}

TEST_CASE("drawn faults keep within what is promised, are of every kind, and end before the calm") {
  std::map<std::size_t, int> kinds;
  int one_way = 0, two_way = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    const Trial trial = sample_trial(seed, 60s, std::nullopt);
    const FaultPlan& plan = trial.plan;
    CHECK(plan.healed_at == Duration{48s});
    CHECK(std::ranges::is_sorted(plan.faults, {}, &TimedFault::at));
    std::map<std::string, bool> is_alive;
    for (const std::string& process : SimSystem::process_names(trial.scenario)) is_alive[process] = true;
    for (const TimedFault& timed : plan.faults) {
      CHECK(timed.at >= Duration{0});
      CHECK(timed.at < plan.healed_at);
      ++kinds[timed.fault.index()];
      if (const auto* weather = std::get_if<WeatherChange>(&timed.fault)) {
        CHECK(weather->quality.loss <= 0.3);
        CHECK(weather->quality.delay_max <= Duration{150ms});
        CHECK(weather->quality.delay_min <= weather->quality.delay_mean);
      } else if (const auto* partition = std::get_if<Partition>(&timed.fault)) {
        CHECK(timed.at + partition->duration <= plan.healed_at);
        const bool goes_back = std::ranges::any_of(plan.faults, [&](const TimedFault& other) {
          const auto* back = std::get_if<Partition>(&other.fault);
          return back && other.at == timed.at && back->from == partition->to && back->to == partition->from;
        });
        ++(goes_back ? two_way : one_way);
      } else if (const auto* pause = std::get_if<Pause>(&timed.fault)) {
        CHECK(timed.at + pause->duration <= plan.healed_at);
        CHECK(pause->duration <= Duration{5s});
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
    CHECK(in_words(plan).size() > plan.faults.size());
  }
  CHECK(kinds.size() == std::variant_size_v<Fault>);
  for (const auto& [kind, count] : kinds) CHECK(count > 50);
  CHECK(one_way > 50);
  CHECK(two_way > 50);
}

TEST_CASE("robots' clocks are within the bound of every coordinator's, or far beyond it and named") {
  int with_clocks = 0, beyond = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    const Trial trial = sample_trial(seed, 60s, std::nullopt);
    const auto& clocks = trial.plan.clocks;
    with_clocks += !clocks.empty();
    beyond += !trial.plan.off_clock.empty();
    for (const RobotSpec& robot : trial.scenario.robots) {
      const Duration robot_s = robot.clock_offset + (clocks.empty() ? Duration{0} : clocks.at("simulator"));
      for (int number = 0; number < trial.scenario.coordinators && !clocks.empty(); ++number) {
        const Duration difference = std::chrono::abs(robot_s - clocks.at(coordinator_process(number)));
        const bool is_off = std::ranges::find(trial.plan.off_clock, robot.id) != trial.plan.off_clock.end();
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

TEST_CASE("the same seed draws the same trial, and the floor does not depend on the length") {
  const Trial a = sample_trial(5, 60s, std::nullopt), b = sample_trial(5, 60s, std::nullopt),
              shorter = sample_trial(5, 20s, std::nullopt), other = sample_trial(6, 60s, std::nullopt);
  CHECK(in_words(a.plan) == in_words(b.plan));
  CHECK(floor_in_words(a.scenario) == floor_in_words(shorter.scenario));
  CHECK(floor_in_words(a.scenario) != floor_in_words(other.scenario));
}
