// SPDX-License-Identifier: Apache-2.0
// Checks that a campaign samples everything that it may sample: each branch of each sampler, and each field
// of each fault.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>
#include <string>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/campaign/building_sampler.hpp"
#include "deploy/trial/simulate/campaign/clock_sampler.hpp"
#include "deploy/trial/simulate/campaign/disturbance_sampler.hpp"
#include "deploy/trial/simulate/campaign/fault_sampler.hpp"
#include "deploy/trial/simulate/campaign/forger.hpp"
#include "deploy/trial/simulate/campaign/rule_mutations.hpp"
#include "deploy/trial/simulate/campaign/scene_sampler.hpp"
#include "deploy/trial/simulate/campaign/trial.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::sampled_kinds_test {

using namespace std::chrono_literals;
using Kind = msg::DisturbanceKind;

constexpr int kPlans = 3000;
constexpr Duration kHealedAt{48'000'000'000}, kDuration{60'000'000'000};

/// Counts the samples that have each property.
class Shares {
 public:
  void begin() { ++samples_; }
  void has(const std::string& property, bool value = true) { counts_[property] += value; }
  double of(const std::string& property) const {
    const auto found = counts_.find(property);
    return found == counts_.end() ? 0 : static_cast<double>(found->second) / samples_;
  }

 private:
  int samples_ = 0;
  std::map<std::string, int> counts_;
};

struct Expected {
  const char* property;
  double min, max;
};

template <typename List>
void check(const Shares& shares, const List& list) {
  for (const auto& [property, min, max] : list) {
    const double share = shares.of(property);
    CAPTURE(property, share);
    CHECK(share >= min);
    CHECK(share <= max);
  }
}

Scenario eleven_robots() {
  return parse_scenario(
      "coordinators: 3\nfield: {length_m: 6, width_m: 5}\ncircle: {count: 11, spacing_m: 0.6}\n",
      "eleven.yaml");
}

std::string kind_of(const std::string& process) { return process.substr(0, process.find(' ')); }

bool is_host(const FaultPlan& plan, const ProcessNames& group) {
  return std::ranges::find(plan.hosts, group) != plan.hosts.end();
}

bool are_agents(const ProcessNames& group) {
  return group.size() > 1 && std::ranges::all_of(group, [](const auto& p) { return kind_of(p) == "agent"; });
}

void add_link(const TimedFault& timed, const LinkChange& change, const FaultPlan& plan, std::size_t processes,
              Shares& links) {
  const LinkQuality& quality = change.quality;
  links.begin();
  links.has("at the start", timed.at == Duration{0});
  links.has("later, all",
            timed.at > Duration{0} && change.from.size() == processes && change.to.size() == processes);
  links.has("from a host", is_host(plan, change.from) && !is_host(plan, change.to));
  links.has("to a host", is_host(plan, change.to) && !is_host(plan, change.from));
  links.has("a fixed delay above 1 ms", quality.delay_min > 1ms);
  links.has("a fixed delay of at most 1 ms", quality.delay_min > 0ms && quality.delay_min <= 1ms);
  links.has("a mean delay above 10 ms", quality.delay_mean - quality.delay_min > 10ms);
  links.has("a mean delay below 2 ms", quality.delay_mean - quality.delay_min < 2ms);
  links.has("the longest delay", quality.delay_max == 150ms);
  links.has("a longest delay above the mean", quality.delay_max > quality.delay_mean);
  links.has("no loss", quality.loss == 0);
  links.has("much loss", quality.loss > 0.03);
  links.has("little loss", quality.loss > 0 && quality.loss <= 0.03);
  links.has("bursts", quality.mean_burst > 1);
  links.has("long bursts", quality.mean_burst > 10);
  links.has("single losses", quality.mean_burst == 1);
  links.has("no duplicates", quality.duplicate == 0);
  links.has("many duplicates", quality.duplicate > 0.02);
  links.has("few duplicates", quality.duplicate > 0 && quality.duplicate <= 0.02);
}

void add_partition(const TimedFault& timed, const Partition& partition, const FaultPlan& plan,
                   std::size_t processes, Shares& partitions) {
  if (std::ranges::any_of(plan.faults, [](const TimedFault& other) {
        const auto* start = std::get_if<Start>(&other.fault);
        return start && start->process.ends_with(" (second)");
      }))
    return;
  partitions.begin();
  const auto counterpart = [&](const TimedFault& other) {
    const auto* back = std::get_if<Partition>(&other.fault);
    return back && other.at == timed.at && back->from == partition.to && back->to == partition.from;
  };
  const bool is_two_way = std::ranges::any_of(plan.faults, counterpart);
  const ProcessNames& group = partition.from.size() < partition.to.size() ? partition.from : partition.to;
  const ProcessNames& rest = partition.from.size() < partition.to.size() ? partition.to : partition.from;
  partitions.has("two ways", is_two_way);
  partitions.has("one way", !is_two_way);
  partitions.has("one way from a small group",
                 !is_two_way && &group == &partition.from && group.size() < rest.size());
  partitions.has("one way to a small group",
                 !is_two_way && &group == &partition.to && group.size() < rest.size());
  partitions.has("a host", group.size() > 1 && is_host(plan, group));
  partitions.has("agents", are_agents(group) && !is_host(plan, group));
  partitions.has("one process from all others", group.size() == 1 && rest.size() + 1 == processes);
  partitions.has("two processes", group.size() == 1 && rest.size() == 1);
  for (const char* const kind : {"coordinator", "agent", "vision", "simulator"}) {
    const auto is_kind = [&](const ProcessNames& names) {
      return names.size() == 1 && kind_of(names[0]) == kind;
    };
    partitions.has(std::string("one ") + kind, is_kind(partition.from) || is_kind(partition.to));
  }
  partitions.has("longer than 3 s", timed.duration.value() > 3s);
  partitions.has("shorter than 0.3 s", timed.duration.value() < 300ms);
}

void add_pause(const Pause& pause, Duration duration, const FaultPlan& plan, Shares& pauses) {
  pauses.begin();
  pauses.has("a host", pause.processes.size() > 1 && is_host(plan, pause.processes));
  pauses.has("agents", are_agents(pause.processes) && !is_host(plan, pause.processes));
  for (const char* const kind : {"coordinator", "agent", "vision", "simulator"})
    pauses.has(std::string("one ") + kind,
               pause.processes.size() == 1 && kind_of(pause.processes[0]) == kind);
  pauses.has("longer than 2 s", duration > 2s);
  pauses.has("shorter than 0.3 s", duration < 300ms);
  pauses.has("a short queue", pause.max_queued < 100);
  pauses.has("a long queue", pause.max_queued > 1000);
}

TEST_CASE("random faults of processes and links have every kind, target and property") {
  const Scenario scenario = eleven_robots();
  const ProcessNames names = system_process_names(scenario);
  Shares plans, links, partitions, pauses, kills;
  std::set<std::size_t> rules, forged;
  for (std::uint64_t seed = 1; seed <= kPlans; ++seed) {
    Rng rng(seed);
    const FaultTimes times(kHealedAt, rng);
    const FaultPlan plan = sample_faults(scenario, names, times, rng);
    std::size_t processes = 0;
    for (const ProcessNames& host : plan.hosts)
      processes += std::ranges::count_if(host, [](const auto& p) { return !p.ends_with(" (second)"); });
    std::map<std::string, int> kinds;
    std::map<std::string, Duration> killed_at;
    for (const TimedFault& timed : plan.faults) {
      if (const auto* change = std::get_if<LinkChange>(&timed.fault)) {
        ++kinds["network"];
        add_link(timed, *change, plan, processes, links);
      } else if (const auto* partition = std::get_if<Partition>(&timed.fault)) {
        ++kinds["partition"];
        add_partition(timed, *partition, plan, processes, partitions);
      } else if (const auto* pause = std::get_if<Pause>(&timed.fault)) {
        ++kinds["pause"];
        add_pause(*pause, timed.duration.value(), plan, pauses);
      } else if (const auto* kill = std::get_if<Kill>(&timed.fault)) {
        killed_at[kill->process] = timed.at;
        if (kill->process.ends_with(")")) continue;
        ++kinds["kill"];
        kills.begin();
        kills.has("a " + kind_of(kill->process));
        kills.has(kill->process);
      } else if (const auto* start = std::get_if<Start>(&timed.fault)) {
        if (start->process.ends_with(" (twin)")) ++kinds["twin"];
        if (start->process.ends_with(" (second)")) ++kinds["second " + kind_of(start->process)];
        if (!killed_at.contains(start->process)) continue;
        const Duration dead = timed.at - killed_at.at(start->process);
        kills.has("dead for no time", dead == Duration{0});
        kills.has("dead for more than 1 s", dead > 1s);
      } else if (const auto* other = std::get_if<StartWithMutatedRule>(&timed.fault)) {
        ++kinds["other rules of a " + kind_of(other->process)];
        if (other->process == "coordinator") ++kinds["other rules of coordinator 0"];
        rules.insert(other->rule);
        if (!std::ranges::any_of(plan.faults, [&](const TimedFault& later) {
              const auto* own = std::get_if<StartWithOwnRules>(&later.fault);
              return own && own->process == other->process;
            }))
          ++kinds["other rules for good"];
      } else if (std::holds_alternative<StartWithOwnRules>(timed.fault)) {
        ++kinds["own rules again"];
      } else if (const auto* forgery = std::get_if<SendForgery>(&timed.fault)) {
        ++kinds["forgery"];
        forged.insert(forgery->forgery);
      }
    }
    plans.begin();
    for (const auto& [kind, count] : kinds) {
      plans.has(kind);
      plans.has("several: " + kind, count > 1);
    }
    plans.has("one host per process", plan.hosts.size() >= processes);
    plans.has("one host", plan.hosts.size() == 1);
    plans.has("a few hosts", plan.hosts.size() > 1 && plan.hosts.size() <= 5);
  }
  check(plans, std::to_array<Expected>({{"network", 0.75, 0.85},
                                        {"several: network", 0.5, 0.75},
                                        {"partition", 0.45, 0.65},
                                        {"several: partition", 0.4, 0.6},
                                        {"pause", 0.55, 0.65},
                                        {"several: pause", 0.45, 0.6},
                                        {"kill", 0.6, 0.8},
                                        {"several: kill", 0.5, 0.75},
                                        {"twin", 0.22, 0.28},
                                        {"several: twin", 0.1, 0.2},
                                        {"second simulator", 0.05, 0.1},
                                        {"second vision", 0.03, 0.08},
                                        {"other rules of a coordinator", 0.03, 0.08},
                                        {"other rules of a agent", 0.03, 0.08},
                                        {"other rules of a vision", 0.01, 0.05},
                                        {"other rules for good", 0.01, 0.04},
                                        {"own rules again", 0.06, 0.12},
                                        {"forgery", 0.08, 0.12},
                                        {"several: forgery", 0.06, 0.12},
                                        {"one host per process", 0.25, 0.4},
                                        {"one host", 0.1, 0.2},
                                        {"a few hosts", 0.45, 0.7}}));
  check(links, std::to_array<Expected>({{"at the start", 0.25, 0.45},
                                        {"later, all", 0.15, 0.45},
                                        {"from a host", 0.1, 0.3},
                                        {"to a host", 0.1, 0.3},
                                        {"a fixed delay above 1 ms", 0.15, 0.25},
                                        {"a fixed delay of at most 1 ms", 0.75, 0.85},
                                        {"a mean delay above 10 ms", 0.15, 0.35},
                                        {"a mean delay below 2 ms", 0.25, 0.45},
                                        {"the longest delay", 0.05, 0.3},
                                        {"a longest delay above the mean", 0.99, 1},
                                        {"no loss", 0.25, 0.35},
                                        {"much loss", 0.25, 0.4},
                                        {"little loss", 0.3, 0.45},
                                        {"bursts", 0.55, 0.65},
                                        {"long bursts", 0.12, 0.28},
                                        {"single losses", 0.35, 0.45},
                                        {"no duplicates", 0.45, 0.55},
                                        {"many duplicates", 0.18, 0.3},
                                        {"few duplicates", 0.2, 0.35}}));
  check(partitions, std::to_array<Expected>({{"two ways", 0.3, 0.7},
                                             {"one way", 0.3, 0.7},
                                             {"one way from a small group", 0.08, 0.4},
                                             {"one way to a small group", 0.08, 0.4},
                                             {"a host", 0.05, 0.3},
                                             {"agents", 0.1, 0.3},
                                             {"one process from all others", 0.1, 0.35},
                                             {"two processes", 0.2, 0.5},
                                             {"one coordinator", 0.1, 0.4},
                                             {"one agent", 0.2, 0.6},
                                             {"one vision", 0.03, 0.2},
                                             {"one simulator", 0.01, 0.15},
                                             {"longer than 3 s", 0.1, 0.3},
                                             {"shorter than 0.3 s", 0.2, 0.5}}));
  check(pauses, std::to_array<Expected>({{"a host", 0.02, 0.12},
                                         {"agents", 0.08, 0.16},
                                         {"one coordinator", 0.15, 0.3},
                                         {"one agent", 0.35, 0.6},
                                         {"one vision", 0.05, 0.12},
                                         {"one simulator", 0.04, 0.09},
                                         {"longer than 2 s", 0.15, 0.3},
                                         {"shorter than 0.3 s", 0.2, 0.4},
                                         {"a short queue", 0.3, 0.45},
                                         {"a long queue", 0.15, 0.35}}));
  check(kills, std::to_array<Expected>({{"a coordinator", 0.15, 0.35},
                                        {"coordinator", 0.05, 0.2},
                                        {"coordinator 1", 0.05, 0.2},
                                        {"coordinator 2", 0.05, 0.2},
                                        {"a vision", 0.05, 0.12},
                                        {"a agent", 0.5, 0.75},
                                        {"dead for no time", 0.15, 0.4},
                                        {"dead for more than 1 s", 0.08, 0.3}}));
  CHECK(rules.size() == rule_mutations().size());
  for (std::size_t i = 0; i < forgeries().size(); ++i) {
    CAPTURE(forgeries()[i].name);
    CHECK(forged.contains(i) != forgeries()[i].is_plausible_report);
  }
}

TEST_CASE("random disturbances of robots have every kind, size and property") {
  const Scenario scenario = eleven_robots();
  Shares plans, bodies, sights, clocks, lifts, carries, power;
  for (std::uint64_t seed = 1; seed <= kPlans; ++seed) {
    Rng rng(seed);
    const FaultTimes times(kHealedAt, rng);
    FaultPlan plan;
    plan.healed_at = kHealedAt;
    sample_disturbances(scenario, times, plan, rng);
    std::set<Kind> kinds;
    plans.begin();
    for (const TimedFault& timed : plan.faults) {
      if (const auto* carry = std::get_if<Carry>(&timed.fault)) {
        carries.begin();
        carries.has("slow", carry->speed_mps < 0.6);
        carries.has("quick", carry->speed_mps > 1.2);
        carries.has("to the left", carry->place_m.x() < 0);
      } else if (const auto* place = std::get_if<Place>(&timed.fault)) {
        lifts.begin();
        lifts.has("several places", place->places_m.size() > 1);
        lifts.has("turned", std::abs(place->heading_rad) > 1);
      } else if (std::holds_alternative<TakeAway>(timed.fault)) {
        plans.has("take away");
      } else if (const auto* disturbance = std::get_if<RobotDisturbance>(&timed.fault)) {
        kinds.insert(disturbance->kind);
        if (disturbance->kind <= Kind::DISTURBANCE_BLOCK) {
          bodies.begin();
          bodies.has("a weak push", disturbance->push_mps.norm() < 0.2);
          bodies.has("a strong push", disturbance->push_mps.norm() > 1);
          bodies.has("to the left", disturbance->push_mps.x() < 0);
          bodies.has("downwards", disturbance->push_mps.y() < 0);
          bodies.has("little grip", disturbance->grip < 0.3);
          bodies.has("much grip", disturbance->grip > 0.6);
          bodies.has("long", disturbance->duration > 1s);
          bodies.has("short", disturbance->duration < 200ms);
        }
        if (disturbance->kind == Kind::DISTURBANCE_SEEN_BESIDE) {
          sights.begin();
          sights.has("near", disturbance->place_m.norm() < 0.005);
          sights.has("far", disturbance->place_m.norm() > 0.1);
          sights.has("long", disturbance->duration > 1s);
          sights.has("short", disturbance->duration < 200ms);
        }
        if (disturbance->kind == Kind::DISTURBANCE_CLOCK) {
          clocks.begin();
          const double offset_s = to_seconds(disturbance->clock_offset);
          clocks.has("ahead", offset_s > 0);
          clocks.has("behind", offset_s < 0);
          clocks.has("right again", offset_s == 0);
          clocks.has("small", offset_s != 0 && std::abs(offset_s) < 0.03);
          clocks.has("large", std::abs(offset_s) > 0.3);
        }
      }
    }
    for (const Kind kind : kinds) plans.has(fmt::format("kind {}", static_cast<int>(kind)));
    for (const RobotEnd end :
         {RobotEnd::kLifted, RobotEnd::kTakenAway, RobotEnd::kClockLeftBound, RobotEnd::kClockBeyondBound})
      plans.has(fmt::format("end {}", static_cast<int>(end)), !robots_with(plan, end).empty());
  }
  for (const Kind kind :
       {Kind::DISTURBANCE_PUSH, Kind::DISTURBANCE_SLIP, Kind::DISTURBANCE_BLOCK, Kind::DISTURBANCE_REBOOT,
        Kind::DISTURBANCE_LIFT, Kind::DISTURBANCE_SWITCH_OFF, Kind::DISTURBANCE_SWITCH_ON,
        Kind::DISTURBANCE_CLOCK, Kind::DISTURBANCE_SEEN_BESIDE, Kind::DISTURBANCE_SEEN_AS,
        Kind::DISTURBANCE_SEEN_FROZEN, Kind::DISTURBANCE_FORGET_POSE}) {
    CAPTURE(kind);
    CHECK(plans.of(fmt::format("kind {}", static_cast<int>(kind))) > 0.03);
  }
  for (const RobotEnd end : {RobotEnd::kLifted, RobotEnd::kTakenAway, RobotEnd::kClockLeftBound})
    CHECK(plans.of(fmt::format("end {}", static_cast<int>(end))) > 0.005);
  check(plans, std::to_array<Expected>({{"take away", 0.02, 0.15}}));
  check(bodies, std::to_array<Expected>({{"a weak push", 0.25, 0.5},
                                         {"a strong push", 0.1, 0.3},
                                         {"to the left", 0.4, 0.6},
                                         {"downwards", 0.4, 0.6},
                                         {"little grip", 0.2, 0.4},
                                         {"much grip", 0.25, 0.45},
                                         {"long", 0.15, 0.35},
                                         {"short", 0.2, 0.45}}));
  check(sights, std::to_array<Expected>(
                    {{"near", 0.2, 0.45}, {"far", 0.15, 0.35}, {"long", 0.15, 0.4}, {"short", 0.25, 0.5}}));
  check(clocks, std::to_array<Expected>({{"ahead", 0.2, 0.4},
                                         {"behind", 0.2, 0.4},
                                         {"right again", 0.3, 0.5},
                                         {"small", 0.25, 0.45},
                                         {"large", 0.05, 0.25}}));
  check(lifts, std::to_array<Expected>({{"several places", 1, 1}, {"turned", 0.5, 0.8}}));
  check(carries,
        std::to_array<Expected>({{"slow", 0.15, 0.35}, {"quick", 0.15, 0.35}, {"to the left", 0.35, 0.65}}));
}

TEST_CASE("random clocks have every kind of error") {
  const Scenario scenario = eleven_robots();
  const ProcessNames names = system_process_names(scenario);
  Shares plans, agents;
  for (std::uint64_t seed = 1; seed <= kPlans; ++seed) {
    Rng rng(seed);
    Scenario changed = scenario;
    FaultPlan plan;
    plan.hosts = {names};
    plan.healed_at = kHealedAt;
    sample_clocks(changed, plan, kDuration, true, rng);
    plans.begin();
    plans.has("none", plan.clocks.empty());
    plans.has("drift", std::ranges::any_of(plan.clocks,
                                           [](const auto& entry) { return entry.second.drift_ppm != 0; }));
    const auto is_out = [](RobotEnd end, const FaultPlan& p) { return robots_with(p, end).size(); };
    const std::size_t out = is_out(RobotEnd::kClockOutOfBound, plan);
    plans.has("robots out of bound", out > 0 && out < scenario.robots.size());
    plans.has("coordinators out of bound", out == scenario.robots.size());
    plans.has("robots that leave the bound or half of it",
              is_out(RobotEnd::kClockLeftBound, plan) + is_out(RobotEnd::kClockBeyondBound, plan) > 0);
    plans.has("robots' offsets",
              std::ranges::any_of(changed.robots, [](const RobotSpec& r) { return r.clock_offset != 0ms; }));
    plans.has("robots' drift",
              std::ranges::any_of(changed.robots, [](const RobotSpec& r) { return r.clock_drift_ppm != 0; }));
    if (plan.clocks.empty()) continue;
    for (const char* const process : {"coordinator", "coordinator 1", "vision", "simulator"})
      plans.has(std::string(process) + "'s offset", plan.clocks.at(process).offset != Duration{0});
    plans.has("vision's offset above 1 ms", std::chrono::abs(plan.clocks.at("vision").offset) > 1ms);
    for (const RobotSpec& robot : scenario.robots) {
      const Duration offset = std::chrono::abs(plan.clocks.at(agent_process(robot.id)).offset);
      agents.begin();
      agents.has("within the bound", offset < from_seconds(scenario.clock_bound_s));
      agents.has("above 1 ms", offset > 1ms && offset <= 20ms);
      agents.has("above 100 ms", offset > 100ms);
    }
  }
  check(plans, std::to_array<Expected>({{"none", 0.3, 0.42},
                                        {"drift", 0.1, 0.22},
                                        {"robots out of bound", 0.05, 0.12},
                                        {"coordinators out of bound", 0.01, 0.04},
                                        {"robots that leave the bound or half of it", 0.03, 0.12},
                                        {"robots' offsets", 0.58, 0.7},
                                        {"robots' drift", 0.1, 0.22},
                                        {"coordinator's offset", 0.58, 0.7},
                                        {"coordinator 1's offset", 0.58, 0.7},
                                        {"vision's offset", 0.58, 0.7},
                                        {"simulator's offset", 0.58, 0.7},
                                        {"vision's offset above 1 ms", 0.4, 0.65}}));
  check(agents,
        std::to_array<Expected>(
            {{"within the bound", 0.6, 0.7}, {"above 1 ms", 0.1, 0.25}, {"above 100 ms", 0.1, 0.25}}));
}

TEST_CASE("random scenes have every kind of floor, obstacle, sensor and pattern") {
  Shares scenes, obstacles, opponents;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    Rng rng(seed);
    Scenario scenario = sample_scene(rng);
    sample_opponents(scenario, rng);
    scenes.begin();
    scenes.has("a building", scenario.map != nullptr);
    scenes.has("obstacles", !scenario.obstacles.empty());
    scenes.has("a square floor", scenario.field.length_m < 1.2 * scenario.field.width_m);
    scenes.has("a long floor", scenario.field.length_m > 1.8 * scenario.field.width_m);
    scenes.has("lost commands", scenario.command_loss > 0);
    scenes.has("missed detections", scenario.vision.miss_probability > 0);
    scenes.has("another delay of vision", scenario.vision.delay != Scenario{}.vision.delay);
    scenes.has("another speed limit", scenario.limits.speed_mps != Scenario{}.limits.speed_mps);
    scenes.has("turned starts", std::abs(scenario.robots.front().start_heading_rad) > 1);
    for (const int count : {1, 2, 3})
      scenes.has(fmt::format("{} coordinators", count), scenario.coordinators == count);
    scenes.has("people in a building", scenario.map && !scenario.opponents.empty());
    scenes.has("opponents", !scenario.map && !scenario.opponents.empty());
    for (const Shape& shape : scenario.obstacles) {
      obstacles.begin();
      obstacles.has("circle", std::holds_alternative<Circle>(shape));
      obstacles.has("box", std::holds_alternative<Box>(shape));
      obstacles.has("polygon", std::holds_alternative<ConvexPolygon>(shape));
    }
    for (const OpponentSpec& opponent : scenario.opponents) {
      CHECK(opponent.speed_mps <= scenario.max_opponent_speed_mps);
      opponents.begin();
      opponents.has("a path", opponent.path_m.size() > 1);
      opponents.has("slow", opponent.speed_mps < 0.3 * scenario.max_opponent_speed_mps);
      opponents.has("quickest", !scenario.map && opponent.speed_mps == scenario.max_opponent_speed_mps);
      opponents.has("small", opponent.radius_m < 0.6 * scenario.radius_m);
      opponents.has("large", opponent.radius_m > scenario.radius_m);
    }
  }
  check(scenes, std::to_array<Expected>({{"a building", 0.08, 0.3},
                                         {"obstacles", 0.3, 0.55},
                                         {"a square floor", 0.1, 0.3},
                                         {"a long floor", 0.1, 0.3},
                                         {"lost commands", 0.24, 0.36},
                                         {"missed detections", 0.24, 0.36},
                                         {"another delay of vision", 0.24, 0.36},
                                         {"another speed limit", 0.24, 0.36},
                                         {"turned starts", 0.55, 0.8},
                                         {"1 coordinators", 0.21, 0.29},
                                         {"2 coordinators", 0.5, 0.7},
                                         {"3 coordinators", 0.09, 0.22},
                                         {"people in a building", 0.04, 0.2},
                                         {"opponents", 0.05, 0.18}}));
  check(obstacles,
        std::to_array<Expected>({{"circle", 0.15, 0.35}, {"box", 0.15, 0.35}, {"polygon", 0.35, 0.65}}));
  check(opponents, std::to_array<Expected>({{"a path", 0.95, 1},
                                            {"slow", 0.05, 0.4},
                                            {"quickest", 0.02, 0.3},
                                            {"small", 0.01, 0.3},
                                            {"large", 0.1, 0.8}}));
}

TEST_CASE("trials have random vision, planners and disturbances in addition to faults") {
  Shares trials;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Trial trial = sample_trial(seed, kDuration, std::nullopt);
    trials.begin();
    trials.has("ghost robots", trial.scenario.vision.ghost_probability > 0);
    trials.has("ghost obstacles", trial.scenario.vision.ghost_obstacle_probability > 0);
    trials.has("many ghost robots", trial.scenario.vision.ghost_probability > 0.1);
    trials.has("another planner", trial.scenario.planner != Scenario{}.planner);
  }
  check(trials, std::to_array<Expected>({{"ghost robots", 0.04, 0.14},
                                         {"ghost obstacles", 0.04, 0.14},
                                         {"many ghost robots", 0.01, 0.08},
                                         {"another planner", 0.38, 0.6}}));
}

}  // namespace sidestep::sampled_kinds_test
