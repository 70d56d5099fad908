// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/config/scenario.hpp"
#include "common/geometry/field.hpp"

namespace sidestep {

/// The floor of a run and what happened on it: what pictures of the run show. Times count from the first
/// grant; if nothing was granted, from the first time that a robot was seen.
struct FloorTrace {
  struct Point {
    double at_s = 0;
    Vec2 position_m{0, 0};
    double speed_mps = 0;
  };
  struct Robot {
    RobotId id = 0;
    Team team = Team::kBlue;
    Vec2 start_m{0, 0};
    std::vector<Vec2> goals_m;
    std::vector<Point> path;  ///< ascending in time; the robot moves evenly between two points
  };
  /// A contact, or a crash of a moving robot with an opponent.
  struct Incident {
    double at_s = 0;
    std::string kind;             ///< kContact or kCrash
    std::vector<RobotId> robots;  ///< one or two
    Vec2 position_m{0, 0};        ///< of the first robot
  };
  static constexpr const char *kContact = "contact", *kCrash = "crash with an opponent";

  Time zero{};  ///< the time from which times count, by the clock of the run; not part of reports
  Field field;
  double radius_m = 0.09;
  double speed_limit_mps = 0;
  std::vector<Shape> obstacles;
  std::vector<Box> walls;  ///< the blocked cells of the map
  std::vector<Robot> robots;
  std::vector<OpponentSpec> opponents;
  std::optional<double> opponents_since_s;  ///< when the opponents began to move; nullopt: not known
  std::vector<Incident> incidents;          ///< in the order of their times; the first ones if there are many
};

}  // namespace sidestep
