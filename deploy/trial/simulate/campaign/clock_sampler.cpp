// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/clock_sampler.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

// Limits of jumps forwards and back. Epochs and incarnations, which are read from clocks, are refused if they
// are an hour ahead, and agents' clocks differ by seconds anyway. Virtual time begins at 1000 s, and must not
// become negative.
constexpr double kMaxClockJump_s = 3580, kMaxSetback_s = 900;

// Any two clocks drift apart by less than the 200 ppm that agents assume.
constexpr double kMaxDrift_ppm = 90;

Duration sample_within(double bound_s, Rng& rng) { return from_seconds(rng.uniform(-bound_s, bound_s)); }

Duration sample_large_offset(Rng& rng) {
  const double size_s = 0.35 * std::pow(100, rng.uniform());
  return from_seconds(rng.chance(0.5) ? size_s : -size_s);
}

class ClockSampler {
 public:
  ClockSampler(Scenario& scenario, FaultPlan& plan, Duration duration, bool robots_have_clocks, Rng& rng)
      : scenario_(scenario),
        plan_(plan),
        duration_(duration),
        have_robots_clocks_(robots_have_clocks),
        // The robot and the coordinator each get half of the clock bound.
        half_bound_s_(0.499 * scenario.clock_bound_s),
        rng_(rng) {}

  void sample() {
    const bool is_out_of_bound = rng_.chance(0.1);
    if (!is_out_of_bound && rng_.chance(0.4)) return;
    has_drift_ = rng_.chance(0.25);
    for (const ProcessNames& host : plan_.hosts) {
      for (const std::string& process : host) plan_.clocks[process] = sample_process(process);
    }
    // The simulator's host only carries the robots, which have their own clocks.
    for (RobotSpec& robot : scenario_.robots) {
      if (!have_robots_clocks_) break;
      const ClockError clock = sample_within_bound();
      robot.clock_offset = clock.offset - plan_.clocks["simulator"].offset;
      robot.clock_drift_ppm = clock.drift_ppm;
    }
    if (is_out_of_bound) take_out_of_bound();
    if (has_drift_ && rng_.chance(0.4)) repeat_for_robots([&](RobotSpec& robot) { drift_away(robot); });
  }

 private:
  /// Samples an error within half of the bound, both at the start and at the end of the run.
  ClockError sample_within_bound() {
    const Duration first = sample_within(half_bound_s_, rng_);
    if (!has_drift_) return {first};
    const Duration last = sample_within(half_bound_s_, rng_);
    return {first, 1e6 * to_seconds(last - first) / to_seconds(duration_)};
  }
  /// Samples a clock error. Agents' clocks may have any offset; vision's must be roughly right.
  ClockError sample_process(const std::string& process) {
    if (process.starts_with("coordinator")) return sample_within_bound();
    if (process == "simulator") return {sample_within(half_bound_s_, rng_)};
    ClockError clock;
    const double u = rng_.uniform();
    clock.offset = process == "vision" ? sample_within(0.005, rng_)
                                       : sample_within(u < 0.6   ? half_bound_s_
                                                       : u < 0.8 ? 0.02
                                                                 : 5,
                                                       rng_);
    if (has_drift_) clock.drift_ppm = rng_.uniform(-kMaxDrift_ppm, kMaxDrift_ppm);
    return clock;
  }
  template <typename Do>
  void repeat_for_robots(Do change) {
    if (!have_robots_clocks_) return;
    for (std::uint64_t left = 1 + rng_.below(3); left > 0; --left) {
      RobotSpec& robot = scenario_.robots[rng_.below(scenario_.robots.size())];
      if (!plan_.ends.contains(robot.id)) change(robot);
    }
  }
  void take_out_of_bound() {
    if (!have_robots_clocks_ || rng_.chance(0.2)) {
      const Duration error = sample_large_offset(rng_);
      for (auto& [process, clock] : plan_.clocks) {
        if (process.starts_with("coordinator")) clock.offset += error;
      }
      for (const RobotSpec& robot : scenario_.robots) plan_.ends[robot.id] = RobotEnd::kClockOutOfBound;
      return;
    }
    repeat_for_robots([&](RobotSpec& robot) {
      robot.clock_offset += sample_large_offset(rng_);
      plan_.ends[robot.id] = RobotEnd::kClockOutOfBound;
    });
  }
  /// Makes the robot's clock leave the bound during the run.
  void drift_away(RobotSpec& robot) {
    const double drift_ppm = rng_.uniform(0.5, 1) * kMaxDrift_ppm;
    robot.clock_drift_ppm = rng_.chance(0.5) ? drift_ppm : -drift_ppm;
    plan_.ends[robot.id] =
        final_clock_state(from_seconds(1e-6 * drift_ppm * to_seconds(duration_)), scenario_);
  }

  Scenario& scenario_;
  FaultPlan& plan_;
  Duration duration_;
  bool have_robots_clocks_;
  double half_bound_s_;
  Rng& rng_;
  bool has_drift_ = false;
};

}  // namespace

void sample_clock_jumps(const Scenario& scenario, const FaultTimes& times, FaultPlan& plan, Rng& rng) {
  if (!rng.chance(0.12)) return;
  const auto offset_of = [&](const std::string& process) {
    const auto found = plan.clocks.find(process);
    return found == plan.clocks.end() ? Duration{0} : found->second.offset;
  };
  for (std::uint64_t left = 1 + rng.below(4); left > 0; --left) {
    const double u = rng.uniform();
    const std::string process =
        u < 0.4 ? coordinator_process(
                      static_cast<int>(rng.below(static_cast<std::uint64_t>(scenario.coordinators))))
        : u < 0.5 ? "vision"
                  : agent_process(scenario.robots[rng.below(scenario.robots.size())].id);
    const double size_s = sample_log_uniform(0.001, kMaxClockJump_s, rng);
    const Duration error = from_seconds(rng.chance(0.5) ? size_s : -std::min(size_s, kMaxSetback_s));
    const Duration at = times.sample(rng);
    const Duration right_at = times.after(at, sample_log_uniform(0.05, 8, rng));
    plan.faults.push_back({at, ClockJump{process, offset_of(process) + error}});
    plan.faults.push_back({right_at, ClockJump{process, offset_of(process)}});
  }
}

RobotEnd final_clock_state(Duration error, const Scenario& scenario) {
  // Without faults, the interval of a measured offset is narrower than this.
  constexpr Duration kMaxInterval = std::chrono::milliseconds(3);
  const bool is_detected = std::chrono::abs(error) > from_seconds(2 * scenario.clock_bound_s) + kMaxInterval;
  return is_detected ? RobotEnd::kClockLeftBound : RobotEnd::kClockBeyondBound;
}

void sample_clocks(Scenario& scenario, FaultPlan& plan, Duration duration, bool robots_have_clocks,
                   Rng& rng) {
  ClockSampler(scenario, plan, duration, robots_have_clocks, rng).sample();
}

}  // namespace sidestep
