// SPDX-License-Identifier: Apache-2.0
// Clocks that jump and later agree again.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/sim/disturbance.hpp"
#include "tests/sim/shuttles.hpp"

namespace sidestep::clock_jumps_test {

constexpr Duration kMaxRecovery = std::chrono::seconds(5);
// The start time. A clock that goes back by an hour must not show a negative time.
constexpr Time kBegin = time_from_ns(100'000'000'000'000);

/// A jump of a clock: from `at` on, the clock is off by `offset`.
struct Jump {
  Duration at{0};
  std::string clock;  ///< name of the process whose clock jumps, or "robot N" for a robot's clock
  Duration offset{0};
};

struct History {
  Scenario scenario;
  std::vector<Jump> jumps;
  Duration clocks_agree_at{0};  ///< time from which all clocks agree
};

/// Samples an offset of 1 ms to an hour, forward or back.
Duration sample_offset(Rng& rng) {
  const double size_s = 0.001 * std::pow(3.59e6, rng.uniform());
  return from_seconds(rng.chance(0.5) ? size_s : -size_s);
}

/// Part of a scenario in which robots see people by lasers, or by cameras.
std::string sight(bool has_lasers) { return has_lasers ? "max_opponent_speed_mps: 0.5\nlaser: {}\n" : ""; }

History sample(std::uint64_t seed) {
  Rng rng(seed);
  const auto coordinators = 1 + static_cast<int>(rng.below(3));
  const bool crosses = rng.chance(0.5);
  History history{shuttles(4, coordinators, crosses, sight(Rng(~seed).chance(0.3))), {}, Duration{0}};
  std::vector<std::string> clocks = system_process_names(history.scenario);
  for (const RobotSpec& robot : history.scenario.robots)
    clocks.push_back("robot " + std::to_string(robot.id));
  history.clocks_agree_at = from_seconds(rng.uniform(2.5, 9));
  const std::uint64_t count = rng.chance(0.4) ? 1 : 2 + rng.below(5);
  // Setting a host's clock moves the clocks of several processes.
  const bool is_common = rng.chance(0.3);
  const Duration common = sample_offset(rng);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Duration at = from_seconds(rng.uniform(0.3, to_seconds(history.clocks_agree_at)));
    history.jumps.push_back({at, clocks[rng.below(clocks.size())], is_common ? common : sample_offset(rng)});
  }
  std::ranges::stable_sort(history.jumps, {}, &Jump::at);
  std::vector<Jump> ends;
  for (const Jump& jump : history.jumps) ends.push_back({history.clocks_agree_at, jump.clock, Duration{0}});
  history.jumps.insert(history.jumps.end(), ends.begin(), ends.end());
  return history;
}

void apply(const Jump& jump, SimSystem& system) {
  if (!jump.clock.starts_with("robot ")) return system.set_clock(jump.clock, jump.offset);
  const auto robot = static_cast<RobotId>(std::stoul(jump.clock.substr(6)));
  auto message = disturbance(robot, msg::DisturbanceKind::DISTURBANCE_CLOCK);
  message.clock_offset_ns(jump.offset.count());
  system.disturb(message);
}

/// Seconds from the agreement of all clocks until all robots drive.
double run(std::uint64_t seed) {
  const History history = sample(seed);
  for (const Jump& jump : history.jumps)
    UNSCOPED_INFO(
        fmt::format("{:.3f} s: {} {:+.4f} s", to_seconds(jump.at), jump.clock, to_seconds(jump.offset)));
  SimSystem system(history.scenario, seed, {}, kBegin);
  MotionWatch motion(system);
  for (const Jump& jump : history.jumps) {
    system.run_until(system.begin() + jump.at);
    apply(jump, system);
  }
  motion.begin();
  double last_s = 0;
  for (bool do_all_drive = false;
       !do_all_drive && system.now() < system.begin() + history.clocks_agree_at + kMaxRecovery;) {
    system.run_for(std::chrono::milliseconds(50));
    do_all_drive = std::ranges::all_of(history.scenario.robots, [&](const RobotSpec& robot) {
      last_s = std::max(last_s, motion.first_motion_s(robot.id).value_or(last_s));
      return motion.first_motion_s(robot.id).has_value();
    });
  }
  for (const RobotSpec& robot : history.scenario.robots) {
    INFO("robot " << robot.id);
    CHECK(motion.first_motion_s(robot.id));
  }
  const Report report = system.metrics().report();
  CHECK(report.unexcused_contacts() == 0);
  CHECK(report.firmware_violations == 0);
  // Ground truth is timestamped by the simulator's clock. While that is wrong, the audit compares positions
  // at different times.
  const bool is_truth_misdated =
      std::ranges::any_of(history.jumps, [](const Jump& jump) { return jump.clock == "simulator"; });
  const std::uint64_t misjudged =
      is_truth_misdated ? report.audit->by_rule[static_cast<std::size_t>(AuditRule::kPosition)] : 0;
  for (const Violation& violation : report.audit->first) UNSCOPED_INFO(to_line(violation));
  CHECK(report.audit->violations == misjudged);
  return last_s;
}

void run_all(std::uint64_t first, std::uint64_t last) {
  std::vector<double> seconds;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    CAPTURE(seed);
    seconds.push_back(run(seed));
  }
  std::ranges::sort(seconds);
  const auto part = [&](double share) {
    return seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  WARN(fmt::format(
      "time until all robots drive: {:.2f} s (median), {:.2f} s (99 %), {:.2f} s (longest); {} histories",
      part(0.5), part(0.99), part(1), seconds.size()));
}

TEST_CASE("after clocks have jumped back and forth, all robots drive within five seconds") { run_all(1, 25); }

TEST_CASE("after clocks have jumped back and forth, all robots drive within five seconds, in 500 histories",
          "[.long][slow]") {
  run_all(1, 500);
}

TEST_CASE("a robot whose clock was set back drives again once the clock is right") {
  const double back_s = GENERATE(0.001, 0.1, 2.5, 5.0, 60.0, 3000.0);
  const bool has_lasers = GENERATE(false, true);
  CAPTURE(back_s, has_lasers);
  SimSystem system(shuttles(3, 1, false, sight(has_lasers)), 1, {}, kBegin);
  MotionWatch motion(system);
  const std::string clock = "robot 1";
  system.run_for(std::chrono::seconds(1));
  apply({Duration{0}, clock, from_seconds(-back_s)}, system);
  system.run_for(std::chrono::seconds(9));
  apply({Duration{0}, clock, Duration{0}}, system);
  motion.begin();
  system.run_for(std::chrono::seconds(2));
  CHECK(motion.first_motion_s(1));
  CHECK(system.metrics().report().audit->violations == 0);
}

TEST_CASE(
    "an agent whose clock was ahead hears its robot again even if the epoch's number is nearly an hour "
    "ahead") {
  // The agent corrects its clock by the messages that it accepts, so which messages it accepts must not
  // depend on its clock.
  const double ahead_s = GENERATE(10.0, 500.0, 3400.0);
  CAPTURE(ahead_s);
  SimSystem system(shuttles(3, 2), 1, {}, kBegin);
  MotionWatch motion(system);
  system.run_for(std::chrono::seconds(1));
  // The next coordinator numbers its epoch by this clock.
  system.set_clock("coordinator", std::chrono::seconds(3400));
  system.kill("coordinator 1");
  system.kill("coordinator");
  system.restart("coordinator");
  system.run_for(std::chrono::seconds(3));
  system.set_clock("coordinator", Duration{0});
  system.run_for(std::chrono::seconds(3));
  const Report before = system.metrics().report();
  system.set_clock("agent 1", from_seconds(ahead_s));
  system.run_for(std::chrono::seconds(1));
  system.set_clock("agent 1", Duration{0});
  // Waits until motions that are still under way have ended.
  system.run_for(kMaxRecovery);
  motion.begin();
  system.run_for(std::chrono::seconds(2));
  REQUIRE(before.epochs.back().epoch > static_cast<Epoch>(to_ns(system.now() + std::chrono::seconds(3300))));
  for (const RobotId robot : {0u, 1u, 2u}) {
    INFO("robot " << robot);
    CHECK(motion.first_motion_s(robot));
  }
  CHECK(system.metrics().report().audit->violations == 0);
}

}  // namespace sidestep::clock_jumps_test
