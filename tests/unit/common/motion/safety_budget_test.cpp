// SPDX-License-Identifier: Apache-2.0
#include "common/motion/safety_budget.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::safety_budget_test {

TEST_CASE("the budget line shows how the margin is composed and how much is to spare") {
  CHECK(budget_line({}, 0.014) ==
        "safety budget: margin 14.0 mm = 2 x 5.0 mm tracking + 4.0 mm for clocks within 0.5 ms at 2 m/s");
  CHECK(
      budget_line({0.006, 0.0005, 2}, 0.025) ==
      "safety budget: margin 25.0 mm = 2 x 6.0 mm tracking + 4.0 mm for clocks within 0.5 ms at 2 m/s + 9.0 "
      "mm to spare");
  CHECK_THAT(
      budget_line({0.005, 0.01, 2}, 0.1),
      EndsWith("warning: clock errors of cameras may shift observed robots by 40.0 mm; tracking covers "
               "2.0 mm: expect own stops, or set tracking_bound_m to 100.0 mm or more"));
  CHECK_THAT(budget_line({0.005, 0, 2}, 0.01),
             EndsWith("warning: clock offsets are known to 0.1 ms at best, so the margin allows 0 m/s: set "
                      "margin_m to 10.4 mm or more"));
  CHECK_THAT(budget_line({0.005, 0, 2}, 0.0104), EndsWith("+ 0.4 mm to spare"));
}

TEST_CASE("tracking errors and clock offsets within the budget do not cause contact") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
  CAPTURE(seed);
  Rng rng(seed);
  double max_clock_share = 0;
  for (int pair = 0; pair < 20'000; ++pair) {
    const Trajectory a = random_trajectory(rng), b = random_trajectory(rng);
    SafetyBudget budget{0.003, 0.002, 0};
    for (const Trajectory* trajectory : {&a, &b}) {
      State state = trajectory->at_start();
      budget.speed_mps = std::max(budget.speed_mps, state.velocity_mps.norm());
      for (const MotionPhase& phase : trajectory->phases()) {
        state = state_after(state, phase.acceleration_mps2, to_seconds(phase.duration));
        budget.speed_mps = std::max(budget.speed_mps, state.velocity_mps.norm());
      }
    }
    // Discs of zero radius, so the clearance is the margin.
    const double margin = clearance_m(a, b, 0);
    const Time from = std::max(a.start(), b.start()) + from_seconds(budget.clock_bound_s);
    const double seconds = std::max(0.0, to_seconds(std::max(a.end(), b.end()) - from));
    const Duration off_a = from_seconds(budget.clock_bound_s), off_b = -off_a;
    for (int i = 0; i < 20; ++i) {
      const Time t = from + from_seconds(rng.uniform(0, seconds));
      const Vec2 body_a = a.state_at(t + off_a).position_m, body_b = b.state_at(t + off_b).position_m;
      const double lost = margin - ((body_a - body_b).norm() - 2 * budget.tracking_bound_m);
      REQUIRE(lost <= budget.required_margin_m());
      // A tighter bound: the clocks differ by twice the clock bound, at the speed of one robot.
      REQUIRE(lost <= 2 * budget.tracking_bound_m + 2 * budget.clock_bound_s * budget.speed_mps + 1e-9);
      max_clock_share = std::max(max_clock_share, lost - 2 * budget.tracking_bound_m);
    }
  }
  // The clock offsets have an effect; otherwise the test would prove nothing.
  CHECK(max_clock_share > 0.001);
}

}  // namespace sidestep::safety_budget_test
