// SPDX-License-Identifier: Apache-2.0
// Robots driven by local methods, in whole systems.
#include <fmt/format.h>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::local_methods_test {

void require_safe(const SimSystem& system) {
  const Report report = system.metrics().report();
  CHECK(report.contacts == 0);
  REQUIRE(report.audit);
  CHECK(report.audit->verdict() == AuditVerdict::kPassed);
}

/// Robots whose paths cross among posts and boxes.
Scenario random_crossing(const std::string& planner, std::uint64_t seed) {
  Rng rng(seed);
  std::string text = "planner: " + planner + "\nfield: {length_m: 6, width_m: 5}\nobstacles:\n";
  for (int i = 0; i < 4; ++i) {
    const double x = rng.uniform(-1.5, 1.5), y = rng.uniform(-1.5, 1.5);
    text += i % 2 == 0
                ? fmt::format("  - {{centre_m: [{}, {}], radius_m: {}}}\n", x, y, rng.uniform(0.05, 0.2))
                : fmt::format("  - box: {{min_m: [{}, {}], max_m: [{}, {}]}}\n", x, y, x + 0.2, y + 0.3);
  }
  text += "robots:\n";
  for (int i = 0; i < 6; ++i) {
    const double side = i % 2 == 0 ? -1 : 1, y = -2 + 0.8 * i;
    text += fmt::format("  - {{id: {}, start_m: [{}, {}], goals_m: [[{}, {}]]}}\n", i, 2.6 * side, y,
                        -2.6 * side, rng.uniform(-0.3, 0.3) - y);
  }
  return parse_scenario(text, "crossing.yaml");
}

TEST_CASE("local methods that follow a path drive several robots to their goals without contact") {
  const std::string planner = GENERATE(as<std::string>(), "nf1-dynamic-window", "bubble-band",
                                       "nf1-band-dynamic-window", "nf1-potential-field");
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 9));
  CAPTURE(planner, seed);
  SimSystem system(random_crossing(planner, seed), seed);
  CHECK(system.run_until_arrived(system.begin() + std::chrono::seconds(60)));
  require_safe(system);
}

TEST_CASE("a local method without a path drives robots across an open floor without contact") {
  const std::string planner = GENERATE(as<std::string>(), "dynamic-window", "potential-field");
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 9));
  CAPTURE(planner, seed);
  Rng rng(seed);
  const std::string text = "planner: " + planner + "\nfield: {length_m: 6, width_m: 5}\nrobots:\n" +
                           fmt::format("  - {{id: 0, start_m: [-2.6, {}], goals_m: [[2.6, {}]]}}\n",
                                       rng.uniform(-2, 2), rng.uniform(-2, 2)) +
                           fmt::format("  - {{id: 1, start_m: [2.6, {}], goals_m: [[-2.6, {}]]}}\n",
                                       rng.uniform(-2, 2), rng.uniform(-2, 2));
  SimSystem system(parse_scenario(text, "open.yaml"), seed);
  CHECK(system.run_until_arrived(system.begin() + std::chrono::seconds(60)));
  require_safe(system);
}

}  // namespace sidestep::local_methods_test
