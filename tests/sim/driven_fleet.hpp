// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "agents/agent/agent_node.hpp"
#include "common/config/scenario.hpp"
#include "coordinator/coordinator_node.hpp"
#include "deploy/audit/auditor.hpp"
#include "tests/sim/driven_floor.hpp"
#include "vision/tracking/vision_node.hpp"

namespace sidestep {

/// How a fleet of driven bases did, by ground truth.
struct FleetOutcome {
  std::size_t arrived = 0;
  std::uint64_t contacts = 0, violations = 0;
  int own_stops = 0;          ///< after robots first found their poses
  double minutes_driven = 0;  ///< summed over all robots until they arrived, or until the end
  /// Part of the robots' time on a free way in which they were slower than FleetDrive::kCreeping_mps.
  double creeping = 0;
  double mean_mps = 0;  ///< on a free way
  std::string first_violation, own_stop_texts;

  double own_stops_per_minute() const { return minutes_driven > 0 ? own_stops / minutes_driven : 0; }
};

/// All robots of a scenario drive to their goals, with bases that sidestep-robot drives. The way of a robot
/// is free if no other robot is within kFree_m, it is farther than that from its start and its goal, and so
/// nothing but the uncertainty of its position can make it slow.
class FleetDrive {
 public:
  static constexpr double kFree_m = 0.8, kCreeping_mps = 0.3;

  FleetDrive(const Scenario& scenario, const BaseSettings& bases, const DriveSettings& drive,
             std::uint64_t seed);

  /// Drives until all robots have arrived, or until the limit.
  FleetOutcome run(Duration limit);

 private:
  void sample();
  bool is_free(std::size_t robot, const std::vector<Vec2>& now_m) const;

  Scenario scenario_;
  SimNetwork network_;
  DrivenFloor floor_;
  SimBus vision_bus_{network_}, coordinator_bus_{network_}, observer_{network_};
  Auditor auditor_{scenario_, {true, {}}};
  VisionNode vision_{vision_bus_, scenario_, 1};
  CoordinatorNode coordinator_;
  std::vector<std::unique_ptr<SimBus>> agent_buses_;
  std::vector<std::unique_ptr<AgentNode>> agents_;
  std::vector<Vec2> last_m_;
  std::vector<int> samples_at_goal_;
  int free_ = 0, slow_ = 0;
  double free_way_m_ = 0;
  FleetOutcome outcome_;
};

}  // namespace sidestep
