// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "deploy/audit/metrics/run_metrics.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/metrics/run_metrics_messages.hpp"

namespace sidestep::run_metrics_test {

TEST_CASE("the metrics record the robots' paths by ground truth, or by vision where there is none") {
  RunMetrics metrics(kTwo);
  metrics.on_truth(truth(1, 0, {body(3, 0, 0), body(7, 0, 1)}));
  metrics.on_truth(truth(2, 1, {body(3, 0.5, 0, 0.8), body(7, 0, 1)}));
  const FloorTrace trace = metrics.floor_trace();
  REQUIRE(trace.robots.size() == 2);
  REQUIRE(trace.robots[0].path.size() == 2);
  CHECK(trace.robots[0].path[1].position_m == Vec2(0.5, 0));
  CHECK(trace.robots[0].path[1].speed_mps == 0.8);

  RunMetrics seen(kTwo);
  msg::WorldState world;
  world.valid_at_ns(to_ns(after(2)));
  world.robots().resize(1);
  world.robots()[0].robot(7);
  world.robots()[0].x_m(0.25);
  seen.on_world_state(world);
  REQUIRE(seen.floor_trace().robots[1].path.size() == 1);
  CHECK(seen.floor_trace().robots[1].path[0].position_m == Vec2(0.25, 0));
}

TEST_CASE("sightings are the latest places of robots that were seen, by ground truth if there is any") {
  RunMetrics metrics(kTwo);
  CHECK(metrics.sightings().empty());
  msg::WorldState world;
  world.valid_at_ns(to_ns(after(1)));
  world.robots().emplace_back().robot(7);
  world.robots()[0].x_m(0.25);
  world.robots()[0].observed_x_m(0.2);
  world.robots()[0].observed_at_ns(to_ns(after(0.9)));
  metrics.on_world_state(world);
  // The robot is not seen any more, and vision predicts where it is.
  world.valid_at_ns(to_ns(after(1.5)));
  world.robots()[0].x_m(0.3);
  metrics.on_world_state(world);
  REQUIRE(metrics.sightings().size() == 1);
  CHECK(metrics.sightings()[0].robot == 7);
  CHECK(metrics.sightings()[0].position_m == Vec2(0.2, 0));
  CHECK(metrics.sightings()[0].at == after(0.9));
  metrics.on_truth(truth(1, 2, {body(3, 0.5, 0, 1.5), body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 2);
  CHECK(metrics.sightings()[0].speed_mps == Approx(1.5));
  CHECK(metrics.sightings()[1].position_m == Vec2(0.75, 1));
  CHECK(metrics.sightings()[1].at == after(2));
  metrics.on_status(status(3, 1, msg::AgentState::AGENT_ABSENT));
  REQUIRE(metrics.sightings().size() == 1);
  CHECK(metrics.sightings()[0].robot == 7);
}

TEST_CASE("a robot that ground truth does not show has no sighting, because it is off the floor") {
  RunMetrics metrics(kTwo);
  metrics.on_truth(truth(1, 1, {body(3, 0.5, 0, 1.5), body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 2);
  metrics.on_truth(truth(2, 1.1, {body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 1);
  CHECK(metrics.sightings()[0].robot == 7);
  metrics.on_truth(truth(3, 1.2, {body(3, 0.4, 0), body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 2);
  CHECK(metrics.sightings()[0].position_m == Vec2(0.4, 0));
  // A robot whose state is invalid is on the floor.
  metrics.on_truth(truth(4, 1.3, {body(3, std::nan(""), 0), body(7, 0.75, 1)}));
  REQUIRE(metrics.sightings().size() == 2);
  CHECK(metrics.sightings()[0].at == after(1.2));
}

}  // namespace sidestep::run_metrics_test
