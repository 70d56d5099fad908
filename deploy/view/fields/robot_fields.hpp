// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>

#include "agents/perception/laser_beams.hpp"
#include "agents/perception/local_grid.hpp"
#include "agents/planning/grids/navigation/cost_grid.hpp"
#include "common/config/scenario.hpp"
#include "deploy/inspect/floor/floor_state.hpp"

namespace sidestep {

/// Fields with which a robot could plan, computed from publicly received messages: agents do not publish
/// their own fields, and may plan differently. Computed for one robot at a time, because they are large.
class RobotFields {
 public:
  /// The scenario must outlive this object.
  explicit RobotFields(const Scenario& scenario);

  /// Adds a scan to the robot's local grid, if a viewer is looking at that robot.
  void on(const msg::LaserScan& scan, const FloorState& floor, Time now);

  /// {"navigation": {"min": [x, y], "cell_m":…, "columns":…, "rows":…, "values": […]}, "path": [[x, y], …],
  /// "band": [[x, y, radius], …], "local": {…, "values": […]}}. `navigation`: E* from the goal that the robot
  /// intends, 0: not reachable, 1 to 255: low to high cost. `path`: the descent in that field. `band`: a
  /// bubble band along it. `local`: the robot's laser, 0: unknown, 1: free, 2: occupied. Members that cannot
  /// be computed are missing.
  [[nodiscard]] nlohmann::ordered_json json(RobotId robot, const FloorState& floor, Time now);

 private:
  struct Local {
    LocalGrid grid;
    Time asked_at{};
  };

  CostGrid costs_with_moving_obstacles(const FloorState& floor, Time now) const;

  const Scenario& scenario_;
  CostGrid fixed_;  ///< costs without moving obstacles
  std::map<RobotId, Local> locals_;
};

}  // namespace sidestep
