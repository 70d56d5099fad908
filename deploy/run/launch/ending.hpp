// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "deploy/audit/metrics/robot_sighting.hpp"

namespace sidestep {

/// Judges from where a robot is seen whether it rests: it has stayed in one place for kRestTime.
class RestWatch {
 public:
  static constexpr Duration kRestTime{300'000'000};

  explicit RestWatch(const RobotSighting& first) : anchor_(first), earlier_(first), last_(first) {}

  /// `tolerance_m`: maximum distance between sightings of a robot at rest. Ignores a sighting that is not
  /// later than the last one, and returns whether it is.
  bool see(const RobotSighting& sighting, double tolerance_m);
  bool is_at_rest() const { return last_.at - anchor_.at >= kRestTime; }
  /// The mean speed over the last tenth of a second or more.
  double speed_mps() const { return speed_mps_.value_or(last_.speed_mps); }

 private:
  RobotSighting anchor_;   ///< the first of the latest sightings in one place
  RobotSighting earlier_;  ///< where the measurement of the speed begins
  RobotSighting last_;
  std::optional<double> speed_mps_;
};

struct EndingSettings {
  /// Maximum time in which robots come to rest by the versions that they have.
  Duration time_to_rest{};
  /// Maximum distance between sightings of a robot at rest.
  double tolerance_m = 0.005;
};

/// Which of the processes that move robots are running.
struct MovingProcesses {
  bool agents = false;
  bool drivers = false;  ///< `sidestep-robot`
};

/// The end of a run, whatever has caused it. All robots come to rest by the versions that they have, then the
/// processes that drive bases end, and only then may vision, coordinators and the simulator end. Each step
/// waits for the processes, and until all robots are seen at rest; if they do not come to rest, it ends after
/// a bounded time, and problem() tells what is not known.
class Ending {
 public:
  enum class Step {
    kRobotsStop,  ///< agents are asked to end; they propose nothing, and end when their robots rest
    kDriversEnd,  ///< drivers are asked to end; they command rest until their bases rest
    kOver
  };
  /// Maximum duration of a step beyond the time in which robots come to rest.
  static constexpr Duration kGrace{3'000'000'000};
  /// If no robot has been seen for this time, robots are not waited for.
  static constexpr Duration kMaxSilence{1'000'000'000};

  Ending(const EndingSettings& settings, Time begin);

  /// `sightings`: the last one of each robot on the floor. Those that were last seen kMaxSilence before the
  /// others, when this is first called, are not on the floor and are ignored.
  Step update(Time now, std::span<const RobotSighting> sightings, const MovingProcesses& running);

  /// The robots that are not known to rest.
  std::vector<RobotId> moving_robots() const;
  /// Why it is not known that all robots rest, e.g. "robot 3 still moves at 0.40 m/s"; empty: they rest.
  std::string problem() const;

 private:
  void see(Time now, std::span<const RobotSighting> sightings);
  bool is_blind(Time now) const { return now - heard_at_ > kMaxSilence; }

  EndingSettings settings_;
  Step step_ = Step::kRobotsStop;
  Time step_ends_by_;
  Time heard_at_;  ///< when a robot was last seen anew
  bool is_blind_ = false;
  bool has_begun_ = false;
  std::map<RobotId, RestWatch> robots_;
};

}  // namespace sidestep
