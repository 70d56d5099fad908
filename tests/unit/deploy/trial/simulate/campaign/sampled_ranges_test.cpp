// SPDX-License-Identifier: Apache-2.0
// Sampled numbers fill their ranges and do not leave them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/campaign/base_sampler.hpp"
#include "deploy/trial/simulate/campaign/clock_sampler.hpp"
#include "deploy/trial/simulate/campaign/disturbance_sampler.hpp"
#include "deploy/trial/simulate/campaign/fault_sampler.hpp"
#include "deploy/trial/simulate/campaign/order_sampler.hpp"
#include "deploy/trial/simulate/campaign/scene_sampler.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::sampled_ranges_test {

using namespace std::chrono_literals;
using Kind = msg::DisturbanceKind;

constexpr Duration kHealedAt{48'000'000'000}, kDuration{60'000'000'000};

/// The minimum and the maximum of the values with the same name.
class Extremes {
 public:
  void add(const std::string& name, double value) {
    auto& [min, max] = found_
                           .try_emplace(name, std::numeric_limits<double>::infinity(),
                                        -std::numeric_limits<double>::infinity())
                           .first->second;
    min = std::min(min, value);
    max = std::max(max, value);
  }
  void add(const std::string& name, Duration value) { add(name, to_seconds(value)); }
  /// Checks that the values lie between both limits and come within 1/30 of the range of each limit.
  void check(const std::string& name, double low, double high) const { check(name, low, high, high - low); }
  /// Like check(), for values whose orders of magnitude are equally likely.
  void check_log(const std::string& name, double low, double high) const {
    const auto& [min, max] = found_.at(name);
    CAPTURE(name, min, max);
    const double step = std::pow(high / low, 1.0 / 30);
    CHECK(min >= low * (1 - 1e-6));
    CHECK(min <= low * step);
    CHECK(max <= high * (1 + 1e-6));
    CHECK(max >= high / step);
  }

 private:
  void check(const std::string& name, double low, double high, double range) const {
    const auto& [min, max] = found_.at(name);
    CAPTURE(name, min, max);
    CHECK(min >= low - 1e-8);
    CHECK(min <= low + range / 30);
    CHECK(max <= high + 1e-8);
    CHECK(max >= high - range / 30);
  }

  std::map<std::string, std::pair<double, double>> found_;
};

Scenario eleven_robots() {
  return parse_scenario(
      "coordinators: 3\nfield: {length_m: 6, width_m: 5}\ncircle: {count: 11, spacing_m: 0.6}\n",
      "eleven.yaml");
}

TEST_CASE("random faults of links and processes fill their ranges") {
  const Scenario scenario = eleven_robots();
  const ProcessNames names = system_process_names(scenario);
  Extremes sizes;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    Rng rng(seed);
    const FaultTimes times(kHealedAt, rng);
    for (const TimedFault& timed : sample_faults(scenario, names, times, rng).faults) {
      if (const auto* change = std::get_if<LinkChange>(&timed.fault)) {
        const LinkQuality& quality = change->quality;
        sizes.add("least delay", quality.delay_min);
        sizes.add("mean delay beyond", quality.delay_mean - quality.delay_min);
        sizes.add("longest delay", quality.delay_max);
        sizes.add("loss", quality.loss);
        sizes.add("burst", quality.mean_burst);
        sizes.add("duplicates", quality.duplicate);
      } else if (std::holds_alternative<Partition>(timed.fault)) {
        if (timed.at < kHealedAt - 8s) sizes.add("partition", timed.duration.value());
      } else if (const auto* pause = std::get_if<Pause>(&timed.fault)) {
        if (timed.at < kHealedAt - 8s) sizes.add("pause", timed.duration.value());
        sizes.add("queue", static_cast<double>(pause->max_queued));
      }
    }
  }
  sizes.check("least delay", 0, 0.02);
  sizes.check_log("mean delay beyond", 0.0002, 0.05);
  sizes.check("longest delay", 0.0004, 0.15);
  sizes.check("loss", 0, 0.3);
  sizes.check_log("burst", 1, 30);
  sizes.check("duplicates", 0, 0.3);
  sizes.check_log("partition", 0.05, 8);
  sizes.check_log("pause", 0.1, 5);
  sizes.check_log("queue", 10, 5000);
}

TEST_CASE("random disturbances of robots fill their ranges") {
  const Scenario scenario = eleven_robots();
  Extremes sizes;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Rng rng(seed);
    const FaultTimes times(kHealedAt, rng);
    FaultPlan plan;
    plan.healed_at = kHealedAt;
    sample_disturbances(scenario, times, plan, rng);
    std::map<std::string, int> counts;
    for (const TimedFault& timed : plan.faults) {
      if (const auto* carry = std::get_if<Carry>(&timed.fault)) {
        sizes.add("speed of carrying", carry->speed_mps);
        continue;
      }
      if (const auto* place = std::get_if<Place>(&timed.fault))
        sizes.add("turn of a place", place->heading_rad);
      const auto* disturbance = std::get_if<RobotDisturbance>(&timed.fault);
      if (!disturbance) continue;
      const bool is_early = timed.at < kHealedAt - 5s;
      if (disturbance->kind == Kind::DISTURBANCE_FORGET_POSE) ++counts["lost poses"];
      if (disturbance->kind == Kind::DISTURBANCE_LIFT) ++counts["lifts"];
      if (disturbance->kind <= Kind::DISTURBANCE_BLOCK || disturbance->kind == Kind::DISTURBANCE_REBOOT)
        ++counts["pushes, slips, blocked wheels and restarts"];
      if (disturbance->kind <= Kind::DISTURBANCE_BLOCK) {
        sizes.add("push", disturbance->push_mps.norm());
        sizes.add("grip", disturbance->grip);
        sizes.add("direction of a blocked wheel", disturbance->heading_rad);
        if (is_early) sizes.add("slip", disturbance->duration);
      } else if (disturbance->kind == Kind::DISTURBANCE_SEEN_BESIDE) {
        sizes.add("error of sight", disturbance->place_m.norm());
        if (is_early) sizes.add("duration of an error of sight", disturbance->duration);
      } else if (disturbance->kind == Kind::DISTURBANCE_CLOCK && disturbance->clock_offset != Duration{0}) {
        sizes.add("clock", std::chrono::abs(disturbance->clock_offset));
      }
    }
    for (const auto& [name, count] : counts) sizes.add(name, count);
  }
  sizes.check("lost poses", 1, 3);
  sizes.check("lifts", 1, 3);
  sizes.check("pushes, slips, blocked wheels and restarts", 1, 8);
  sizes.check("speed of carrying", 0.3, 1.5);
  sizes.check("turn of a place", -std::numbers::pi, std::numbers::pi);
  sizes.check_log("push", 0.05, 2);
  sizes.check("grip", 0.05, 0.9);
  sizes.check("direction of a blocked wheel", -std::numbers::pi, std::numbers::pi);
  sizes.check_log("slip", 0.05, 3);
  sizes.check_log("error of sight", 0.0005, 0.5);
  sizes.check_log("duration of an error of sight", 0.03, 4);
  sizes.check_log("clock", 0.0006, 900);
}

TEST_CASE("random clocks fill their ranges") {
  const Scenario scenario = eleven_robots();
  const ProcessNames names = system_process_names(scenario);
  const double half_bound_s = 0.499 * scenario.clock_bound_s;
  Extremes sizes;
  int jumped = 0, jumped_coordinators = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Rng rng(seed);
    Scenario changed = scenario;
    FaultPlan plan;
    plan.hosts = {names};
    plan.healed_at = kHealedAt;
    sample_clocks(changed, plan, kDuration, true, rng);
    if (plan.clocks.empty()) continue;
    sizes.add("vision", plan.clocks.at("vision").offset);
    sizes.add("simulator", plan.clocks.at("simulator").offset);
    sizes.add("agent", plan.clocks.at(agent_process(0)).offset);
    if (const double drift_ppm = plan.clocks.at("vision").drift_ppm; drift_ppm != 0)
      sizes.add("drift", drift_ppm);
    const std::size_t out = robots_with(plan, RobotEnd::kClockOutOfBound).size();
    if (out > 0 && out < scenario.robots.size()) sizes.add("robots out of bound", static_cast<double>(out));
    if (out == 0) sizes.add("coordinator", plan.clocks.at("coordinator").offset);
    for (const RobotSpec& robot : changed.robots) {
      const auto end = plan.ends.find(robot.id);
      const Duration offset = robot.clock_offset + plan.clocks.at("simulator").offset;
      if (end == plan.ends.end())
        sizes.add("robot", offset);
      else if (end->second == RobotEnd::kClockOutOfBound && out < scenario.robots.size() &&
               std::abs(to_seconds(offset)) > 0.3)
        sizes.add("robot out of bound", std::abs(to_seconds(offset)));
    }
    FaultPlan jumps;
    jumps.healed_at = kHealedAt;
    const FaultTimes times(kHealedAt, rng);
    sample_clock_jumps(scenario, times, jumps, rng);
    for (const TimedFault& timed : jumps.faults) {
      const ClockJump& jump = std::get<ClockJump>(timed.fault);
      ++jumped;
      jumped_coordinators += jump.process.starts_with("coordinator");
      const double offset_s = to_seconds(jump.offset);
      if (offset_s != 0) sizes.add(offset_s > 0 ? "jump ahead" : "jump back", std::abs(offset_s));
    }
  }
  CHECK(jumped_coordinators > 0.36 * jumped);
  CHECK(jumped_coordinators < 0.44 * jumped);
  sizes.check("robots out of bound", 1, 3);
  sizes.check("vision", -0.005, 0.005);
  sizes.check("simulator", -half_bound_s, half_bound_s);
  sizes.check("coordinator", -half_bound_s, half_bound_s);
  sizes.check("robot", -half_bound_s, half_bound_s);
  sizes.check("agent", -5, 5);
  sizes.check("drift", -90, 90);
  sizes.check_log("robot out of bound", 0.35 - half_bound_s, 35 + half_bound_s);
  sizes.check_log("jump ahead", 0.001, 3580);
  sizes.check_log("jump back", 0.001, 900);
}

TEST_CASE("random scenes, sensors and lasers fill their ranges") {
  Extremes sizes;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    Rng rng(seed);
    for (int i = 0; i < 5; ++i) {
      const auto bases = sample_driven_bases(rng);
      if (!bases) continue;
      const BaseFloorSettings& floor = bases->floor;
      sizes.add("latency of bases", bases->latency);
      sizes.add("drag", floor.bases.drag_per_s);
      sizes.add("turning", floor.bases.max_turn_radps);
      if (floor.pace.speeds.size() > 1) sizes.add("pace", floor.pace.speeds.front());
      if (floor.pace.step > Duration{0}) sizes.add("step", floor.pace.step);
      if (floor.camera_error_m > 0) sizes.add("camera error", floor.camera_error_m);
    }
    Scenario scenario = sample_scene(rng);
    const auto robots = static_cast<double>(scenario.robots.size());
    sizes.add("robots", robots);
    sizes.add("aspect", scenario.field.length_m / scenario.field.width_m);
    sizes.add("area", scenario.field.length_m * scenario.field.width_m / robots);
    if (scenario.command_loss > 0) sizes.add("lost commands", scenario.command_loss);
    if (scenario.vision.miss_probability > 0) sizes.add("missed", scenario.vision.miss_probability);
    if (scenario.vision.delay != Scenario{}.vision.delay) sizes.add("delay", scenario.vision.delay);
    sizes.add("speed", scenario.limits.speed_mps);
    sizes.add("heading", scenario.robots.front().start_heading_rad);
    if (scenario.map)
      sizes.add("area with a building", scenario.field.length_m * scenario.field.width_m / robots);
    scenario.map.reset();
    scenario.obstacles.clear();
    scenario.robots.resize(5);
    for (int i = 0; i < 3; ++i) {
      scenario.laser.reset();
      sample_lasers(scenario, rng);
      if (!scenario.laser) continue;
      sizes.add("beams", scenario.laser->settings.beams);
      sizes.add("range", scenario.laser->settings.max_range_m);
      sizes.add("rate", scenario.laser->rate_hz);
      sizes.add("error", scenario.laser->range_error_m);
      sizes.add("dropouts", scenario.laser->dropout_probability);
      sizes.add("person", scenario.laser->person_radius_m);
      // Without obstacles people walk straight from place to place.
      for (const OpponentSpec& person : scenario.opponents)
        sizes.add("places of a person", static_cast<double>(person.path_m.size()));
    }
  }
  sizes.check("latency of bases", 0.01, 0.29);
  sizes.check("drag", 0, 1);
  sizes.check_log("turning", 1, 20);
  sizes.check("pace", 0.5, 1.02);
  sizes.check("step", 0.005, 0.02);
  sizes.check("camera error", 0, 0.02);
  sizes.check("robots", 5, 30);
  sizes.check("aspect", 1, 2);
  sizes.check_log("area", 0.5, 3);
  sizes.check("lost commands", 0, 0.3);
  sizes.check("missed", 0, 0.3);
  sizes.check("delay", 0.002, 0.04);
  sizes.check("speed", 0.8, Scenario{}.limits.speed_mps);
  sizes.check("heading", -3, 3);
  sizes.check("beams", 240, 719);
  sizes.check("range", 4, 10);
  sizes.check("rate", 10, 30);
  sizes.check("error", 0.005, 0.03);
  sizes.check("dropouts", 0, 0.05);
  sizes.check("person", 0.1, 0.2);
  sizes.check("places of a person", 3, 5);
  sizes.check("area with a building", 1.5, 3);
}

TEST_CASE("random orders fill their ranges") {
  const Scenario scenario = eleven_robots();
  Extremes sizes;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Rng rng(seed);
    const FaultTimes times(kHealedAt, rng);
    FaultPlan plan;
    plan.healed_at = kHealedAt;
    sample_orders(scenario, times, plan, rng);
    for (const TimedFault& timed : plan.faults) {
      const Order& order = std::get<GiveOrder>(timed.fault).order;
      if (order.kind != msg::OrderKind::ORDER_ZONE) continue;
      sizes.add("number", order.zone_number);
      sizes.add("radius", order.zone.radius_m);
      if (order.zone.speed_limit_mps) sizes.add("speed limit", *order.zone.speed_limit_mps);
    }
  }
  sizes.check("number", 0, 2);
  sizes.check("radius", 0.05, 0.4);
  sizes.check("speed limit", 0.1, 1);
}

}  // namespace sidestep::sampled_ranges_test
