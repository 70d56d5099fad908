// SPDX-License-Identifier: Apache-2.0
// Why robots do not carry out their orders, in whole systems.
#include "deploy/run/order/order_text.hpp"
#include "deploy/run/order/robot_watch.hpp"
#include "tests/catch.hpp"
#include "tests/sim/disturbance.hpp"
#include "tests/sim/ordered_system.hpp"

namespace sidestep::hindrances_test {

using std::chrono::seconds;

TEST_CASE("a client learns why robots that are lifted, switched off or held do not drive") {
  OrderedSystem run(waiting_robots(4), 1);
  SimBus bus(run.system.network());
  OrderClient bob(bus, client_id("bob"), "bob"), operator_client(bus, kOperator);
  RobotWatch watch(bus, operator_client, false);
  watch.watch_all();
  run.system.run_for(seconds(2));
  CHECK(watch.all_hindrances().empty());
  msg::Disturbance lift = disturbance(0, msg::DisturbanceKind::DISTURBANCE_LIFT);
  run.system.disturb(lift);
  msg::Disturbance switch_off = disturbance(1, msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF);
  run.system.disturb(switch_off);
  bob.hold(2);
  for (const RobotId robot : {0u, 1u, 2u, 3u}) operator_client.go(robot, {{{0.2, 0.6 * robot - 0.9}}});
  run.system.run_for(seconds(6));
  const auto text = [&](RobotId robot) { return to_text(watch.hindrances(robot)); };
  CHECK(text(0) == "it is off the floor");
  CHECK_THAT(text(1), StartsWith("it has sent no report for "));
  CHECK(text(2) == "it is held by client bob");
  CHECK(text(3).empty());
  const std::string table = to_table(operator_client.reports(), watch.all_hindrances());
  INFO(table);
  CHECK_THAT(table, ContainsSubstring("    0  off floor ") && ContainsSubstring("    1  silent ") &&
                        ContainsSubstring("    2  held "));
  bob.resume(2);
  run.system.run_for(seconds(2));
  CHECK(text(2).empty());
}

}  // namespace sidestep::hindrances_test
