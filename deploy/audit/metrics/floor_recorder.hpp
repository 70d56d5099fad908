// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "deploy/audit/metrics/floor_trace.hpp"
#include "deploy/audit/metrics/path_recorder.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Records, in bounded memory, what happens on the floor of a run.
class FloorRecorder {
 public:
  static constexpr std::size_t kMaxIncidents = 100;

  /// The scenario must outlive the recorder.
  explicit FloorRecorder(const Scenario& scenario);

  /// Records where the robot with this index in the scenario is.
  void place(std::size_t robot, const PathRecorder::Point& point) { paths_[robot].add(point); }
  /// Records contacts and crashes; the robots of the same message must have been placed.
  void on_truth(const msg::GroundTruth& truth);

  FloorTrace trace(std::optional<Time> granting_since) const;

 private:
  struct Incident {
    Time at{};
    const char* kind;
    std::vector<RobotId> robots;
    Vec2 position_m;
  };
  void add_incident(Time at, const char* kind, RobotId first, RobotId second);
  /// When the simulated world began, from the numbers and times of two messages.
  std::optional<Time> world_began() const;

  const Scenario& scenario_;
  std::vector<PathRecorder> paths_;
  std::vector<Incident> incidents_;
  std::uint64_t simulator_ = 0, contacts_ = 0, crashes_ = 0;  ///< of the latest incarnation of the simulator
  struct Numbered {
    std::uint64_t incarnation = 0, number = 0;
    Time at{};
  };
  std::optional<Numbered> first_, latest_;  ///< messages of the first incarnation
};

}  // namespace sidestep
