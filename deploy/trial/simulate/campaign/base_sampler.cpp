// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/base_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace sidestep {
namespace {

using std::chrono::milliseconds;

// A robot's lead is at most 0.3 s (coordinator/PROTOCOL.md).
constexpr double kMaxLatency_s = 0.29;

double slowest(const PaceSettings& pace) { return std::min(1.0, std::ranges::min(pace.speeds)); }

void sample_pace(PaceSettings& pace, Rng& rng) {
  if (rng.chance(0.3)) {
    // A sudden change of more than this takes a fast robot out of its bound, as the README says.
    const double speed = rng.uniform(0.5, 1.02);
    pace.speeds = {speed, speed * rng.uniform(0.98, 1.02)};
    pace.speed_duration = from_seconds(rng.uniform(0.5, 10));
  }
  if (rng.chance(0.3)) {
    pace.step = from_seconds(1 / rng.uniform(50, 200));
    pace.max_step_delay = from_seconds(rng.uniform(0, 0.005));
  }
}

}  // namespace

BaseSettings sample_base(Rng& rng, Duration min_latency, Duration max_latency) {
  BaseSettings base;
  base.latency = from_seconds(rng.uniform(to_seconds(min_latency), to_seconds(max_latency)));
  base.drag_per_s = rng.uniform(0, 1);
  base.max_turn_radps = std::pow(10, rng.uniform(0, 1.3));
  base.braking_mps2 = rng.uniform(5.2, 8);
  base.silence_timeout = from_seconds(rng.chance(0.3) ? 1 : rng.uniform(0.05, 0.3));
  base.coast = from_seconds(rng.chance(0.5) ? 0 : rng.uniform(0, 1.2));
  return base;
}

std::optional<DrivenBaseSettings> sample_driven_bases(Rng& rng) {
  if (!rng.chance(0.15)) return std::nullopt;
  DrivenBaseSettings bases;
  BaseFloorSettings& floor = bases.floor;
  sample_pace(floor.pace, rng);
  if (rng.chance(0.3)) floor.camera_error_m = rng.uniform(0, 0.02);
  const double slow = slowest(floor.pace);
  // In simulated time, a command arrives at the begin of the step, which is on average half a step earlier.
  const Duration other = kMotorResponse - (floor.pace.step + floor.pace.max_step_delay) / 2;
  floor.bases = sample_base(rng, milliseconds(0), from_seconds(slow * kMaxLatency_s) - kMotorResponse);
  bases.latency = from_seconds(to_seconds(floor.bases.latency + other) / slow);
  bases.turn_radps = std::min(bases.turn_radps, 0.9 * floor.bases.max_turn_radps * slow);
  return bases;
}

void prepare_for(Scenario& scenario, const DrivenBaseSettings& bases) {
  const double slow = slowest(bases.floor.pace);
  scenario.limits.speed_mps *= slow;
  scenario.limits.acceleration_mps2 *= slow * slow;
  scenario.limits.deceleration_mps2 *= slow * slow;
  scenario.odometry.scale_error = std::max(scenario.odometry.scale_error, 0.4 * (1 / slow - 1));
  scenario.vision.position_noise_m = 0.0015;
  scenario.tracking_bound_m = 0.04;
  scenario.margin_m = budget_of(scenario).required_margin_m();
}

std::set<std::string> fault_kinds(const DrivenBaseSettings& bases) {
  std::set<std::string> kinds{"robots with lead"};
  if (bases.floor.pace.speeds != PaceSettings{}.speeds) kinds.insert("simulation not in real time");
  if (bases.floor.pace.step > Duration{0}) kinds.insert("simulation in steps");
  if (bases.floor.camera_error_m > 0) kinds.insert("cameras that disagree");
  return kinds;
}

std::string to_text(const DrivenBaseSettings& bases) {
  const BaseSettings& base = bases.floor.bases;
  const PaceSettings& pace = bases.floor.pace;
  std::string text =
      fmt::format("driven bases that obey after {:.0f} ms, drag {:.2f}/s, at most {:.1f} rad/s",
                  1e3 * to_seconds(bases.latency), base.drag_per_s, base.max_turn_radps);
  if (pace.speeds != PaceSettings{}.speeds)
    text += fmt::format(", at {:.2f} and {:.2f} of real time", pace.speeds.front(), pace.speeds.back());
  if (pace.step > Duration{0})
    text += fmt::format(", in steps of {:.1f} ms, late by up to {:.1f} ms", 1e3 * to_seconds(pace.step),
                        1e3 * to_seconds(pace.max_step_delay));
  if (bases.floor.camera_error_m > 0)
    text += fmt::format(", cameras {:.0f} mm off", 1e3 * bases.floor.camera_error_m);
  return text;
}

}  // namespace sidestep
