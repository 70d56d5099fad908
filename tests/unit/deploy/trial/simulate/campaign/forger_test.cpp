// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/forger.hpp"

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep::forger_test {

using namespace std::chrono_literals;

TEST_CASE("a forged world state shows each robot a metre away at a later observation time") {
  const Scenario scenario =
      parse_scenario("field: {length_m: 6, width_m: 4}\ncircle: {count: 2, spacing_m: 3}\n", "pair.yaml");
  SimNetwork network(1, Time{1000s}, scenario.network);
  Forger forger(network, scenario, 0);
  int forged = 0;
  for (const Forgery& forgery : forgeries()) {
    if (!std::string(forgery.name).starts_with("world: robots elsewhere")) continue;
    ++forged;
    msg::WorldState& world = forger.world();
    world.robots().assign(2, {});
    for (std::size_t i = 0; i < 2; ++i) {
      world.robots()[i].observed_x_m(static_cast<double>(i));
      world.robots()[i].observed_at_ns(1'000'000'000'000);
    }
    forgery.change(forger);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(world.robots()[i].observed_x_m() == static_cast<double>(i) + 1);
      CHECK(world.robots()[i].observed_at_ns() > 1'000'000'000'000);
    }
  }
  CHECK(forged == 2);
}

}  // namespace sidestep::forger_test
