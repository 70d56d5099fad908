// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/fields/robot_fields.hpp"

#include <nlohmann/json.hpp>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "deploy/view/monitor/monitor.hpp"
#include "tests/catch.hpp"

namespace sidestep::robot_fields_test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

/// A simulated run with a monitor.
struct Run {
  Scenario scenario;
  SimSystem system{scenario, 1};
  SimBus bus{system.network()};
  Monitor monitor;
  RobotFields fields{scenario};

  explicit Run(const std::string& name)
      : scenario(load_scenario(std::string(SIDESTEP_SOURCE_DIR "/deploy/scenarios/") + name)),
        monitor((bus.become_observer(), bus), settings()) {
    monitor.on_any_message([this](const AnyMessage& message) {
      if (std::string(message.topic.name) == topics::kScan.name)
        fields.on(*static_cast<const msg::LaserScan*>(message.message), monitor.floor(), bus.now());
    });
  }
  MonitorSettings settings() const {
    MonitorSettings result;
    result.scenario = &scenario;
    return result;
  }
  Json json(RobotId robot) { return fields.json(robot, monitor.floor(), bus.now()); }
};

double value_at(const Json& grid, const Vec2& p) {
  const double cell_m = grid.at("cell_m");
  const auto column = static_cast<std::size_t>((p.x() - grid.at("min")[0].get<double>()) / cell_m);
  const auto row = static_cast<std::size_t>((p.y() - grid.at("min")[1].get<double>()) / cell_m);
  return grid.at("values")[row * grid.at("columns").get<std::size_t>() + column];
}

TEST_CASE("a robot's navigation function falls towards its goal, and its band is free of obstacles") {
  Run run("crossing.yaml");
  const RobotId robot = run.scenario.robots[0].id;
  const Vec2 goal = run.scenario.robots[0].goals.front().position_m;
  // Runs until the robot drives but is still far from its goal.
  const auto is_driving = [&] {
    const auto known = run.monitor.floor().robots().find(robot);
    return known != run.monitor.floor().robots().end() && known->second.granted && known->second.feedback &&
           std::hypot(known->second.feedback->value.vx_mps(), known->second.feedback->value.vy_mps()) > 0.5;
  };
  for (int i = 0; i < 100 && !is_driving(); ++i) run.system.run_for(50ms);
  REQUIRE(is_driving());
  const Json json = run.json(robot);
  const msg::Feedback& feedback = run.monitor.floor().robots().at(robot).feedback->value;
  const Vec2 at(feedback.x_m(), feedback.y_m());
  CHECK(value_at(json.at("navigation"), goal) <= 3);
  CHECK(value_at(json.at("navigation"), at) > 20);
  for (const Circle& obstacle : circles_of(run.scenario.obstacles))
    CHECK(value_at(json.at("navigation"), obstacle.centre_m) == 0);
  const Json& path = json.at("path");
  CHECK((Vec2(path.back()[0], path.back()[1]) - goal).norm() < 0.1);
  REQUIRE(json.at("band").size() >= 3);
  for (const Json& bubble : json.at("band"))
    for (const Shape& obstacle : run.scenario.obstacles)
      CHECK(signed_distance(Vec2(bubble[0], bubble[1]), obstacle) >= bubble[2].get<double>() - 0.01);
  CHECK_FALSE(json.contains("local"));
  CHECK(run.json(77).empty());
}

TEST_CASE("the local grid of a robot with a laser shows walls of its map") {
  Run run("house-laser.yaml");
  run.system.run_for(1s);
  const RobotId robot = run.scenario.robots[0].id;
  (void)run.json(robot);  // the first request of a viewer
  run.system.run_for(2s);
  const Json json = run.json(robot);
  const Json& local = json.at("local");
  std::size_t occupied = 0, free = 0;
  for (const Json& value : local.at("values")) {
    occupied += value == 2;
    free += value == 1;
  }
  CHECK(occupied > 50);
  CHECK(free > 1000);
  CHECK(json.contains("navigation"));
  CHECK(json.contains("band"));
}

}  // namespace sidestep::robot_fields_test
