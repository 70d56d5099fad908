// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <fmt/format.h>
#include <map>
#include <string>

#include "common/config/scenario_loader.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {

/// Robots that drive back and forth thirty times, each in its own lane. With `crosses`, every second lane
/// crosses the others.
inline Scenario shuttles(int robots, int coordinators, bool crosses = false, const std::string& more = "") {
  std::string text =
      fmt::format("field: {{length_m: 6, width_m: 6}}\ncoordinators: {}\n{}robots:\n", coordinators, more);
  for (int i = 0; i < robots; ++i) {
    const double side_m = -1.2 + 0.8 * i;
    const bool is_across = crosses && i % 2 == 1;
    const auto place = [=](double along_m) {
      return is_across ? fmt::format("[{}, {}]", side_m, along_m) : fmt::format("[{}, {}]", along_m, side_m);
    };
    text += fmt::format("  - {{id: {}, start_m: {}, goals_m: [", i, place(-2));
    for (int trip = 0; trip < 30; ++trip) text += place(2) + ", " + place(-2) + (trip < 29 ? ", " : "");
    text += "]}\n";
  }
  return parse_scenario(text, "shuttles.yaml");
}

/// Records when each robot was in motion.
class MotionWatch {
 public:
  static constexpr double kMotion_mps = 0.05;

  explicit MotionWatch(SimSystem& system) : system_(system) {
    system.observer_bus().subscribe(topics::kTruth, [this](const msg::GroundTruth& truth) {
      for (const msg::TrueRobotState& robot : truth.robots())
        if (std::hypot(robot.vx_mps(), robot.vy_mps()) > kMotion_mps) note_motion(robot.robot());
    });
  }
  void begin() {
    moved_at_.clear();
    longest_rest_s_.clear();
    begin_ = system_.now();
  }
  /// The longest time since begin() for which a robot was at rest.
  double longest_rest_s(RobotId robot) {
    const double last_s = to_seconds(system_.now() - last_motion(robot));
    return std::max(longest_rest_s_[robot], last_s);
  }
  /// Time from begin() to a robot's first motion; nullopt if the robot did not move.
  std::optional<double> first_motion_s(RobotId robot) const {
    const auto found = first_s_.find({robot, begin_});
    return found == first_s_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  Time last_motion(RobotId robot) const {
    const auto found = moved_at_.find(robot);
    return found == moved_at_.end() ? begin_ : found->second;
  }
  void note_motion(RobotId robot) {
    const Time now = system_.now();
    first_s_.try_emplace({robot, begin_}, to_seconds(now - begin_));
    double& longest_s = longest_rest_s_[robot];
    longest_s = std::max(longest_s, to_seconds(now - last_motion(robot)));
    moved_at_[robot] = now;
  }

  SimSystem& system_;
  Time begin_{};
  std::map<RobotId, Time> moved_at_;
  std::map<RobotId, double> longest_rest_s_;
  std::map<std::pair<RobotId, Time>, double> first_s_;
};

}  // namespace sidestep
