// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

/// A robot on the floor, as shown by ground truth or vision.
struct ObservedRobot {
  Vec2 position_m{0, 0};
  double speed_mps = 0;
  double inflation_m = 0;    ///< inflation of the version that it executes
  bool is_in_place = false;  ///< it is where its version prescribes, and a ledger has contained that version
  /// Distance of its edge from the nearest obstacle; infinite if that is far away. Needed only while
  /// has_excuse().
  double from_obstacles_m = std::numeric_limits<double>::infinity();
};

struct DisturbanceSettings {
  double contact_distance_m = 0;  ///< robots farther apart than this do not touch
  double separation_m = 0;        ///< robots without inflation that are nearer than this are in conflict
  /// A motion granted before a disturbance became known ends within this time.
  Duration braking_time{0};
  bool knows_causes = true;  ///< whether every announcement of a cause is received
  double margin_m = 0;  ///< robots without inflation that are nearer to obstacles are in conflict with them
};

/// Decides which contacts are excused by disturbances of robots. A contact of two robots is excused only if
/// one of them was disturbed, or was pushed by a disturbed robot. The excuse of a pair begins with the
/// disturbance. It ends when the disturbed robot is back in place (at rest or moving), the other robot has
/// rested since then, and the two are not in conflict. A contact with an obstacle is excused in the same way:
/// a robot that was pushed towards an obstacle may have to rest nearer to it than the margin. Robots are
/// identified by their index in the roster. Times are those of ground truth or vision.
class Disturbances {
 public:
  static constexpr std::string_view kUnknownCause = "unknown";
  static constexpr std::string_view kClockCause = "clock";

  Disturbances(std::size_t robots, const DisturbanceSettings& settings);

  /// An operator's message names the cause of a disturbance. This alone excuses nothing.
  void announce(std::size_t robot, std::string_view cause);
  /// Records a disturbance until `end`, or Time::max() if unknown. Repetitions count once.
  void disturb(std::size_t robot, Time end, Time now);
  /// Records the beginning of a contact; nullopt means anything other than a robot. Returns the cause if the
  /// contact is excused. A robot pushed by a disturbed one counts as disturbed by the same cause while they
  /// touch.
  [[nodiscard]] std::optional<std::string_view> on_contact(std::optional<std::size_t> first,
                                                           std::optional<std::size_t> second, Time now);
  /// Updates with the robots on the floor at this time.
  void update(Time now, const std::vector<std::optional<ObservedRobot>>& robots);

  /// Call if messages were missed. Then it is unknown when a currently disturbed robot will be back in place.
  void on_missed();
  /// Call if messages with positions were missed. Calls on_missed(), and forgets when robots came to rest.
  void on_reference_missed();
  /// Whether the robot may be disturbed although no received message says so.
  bool is_uncertain(std::size_t robot) const { return states_[robot].is_uncertain; }
  /// Whether the robot was disturbed and is not back in place.
  bool is_displaced(std::size_t robot) const;
  /// Whether the robot has rested out of place since a disturbance. A robot that gets no usable observations
  /// never learns of its displacement.
  bool rests_displaced(std::size_t robot) const { return states_[robot].rests_displaced; }
  /// Whether any contact of the robot would be excused.
  bool has_excuse(std::size_t robot) const { return states_[robot].displacement.has_value(); }
  /// Whether the robot was ever disturbed.
  bool was_disturbed(std::size_t robot) const { return states_[robot].reported_end.has_value(); }
  /// The observed time, summed over all pairs of robots on the floor, and the part of it in which a contact
  /// of the pair would have been excused.
  double pair_s() const { return pair_s_; }
  double excused_pair_s() const { return excused_pair_s_; }

 private:
  struct Displacement {
    std::string_view cause;
    Time end{};  ///< end of the disturbance
    std::optional<Time> back_at;
    std::vector<bool> is_over;  ///< whether contacts are no longer excused, by other robot
    bool is_over_for_obstacles = false;
  };
  struct State {
    std::optional<Time> reported_end;  ///< end of the disturbance, as last reported
    std::optional<std::string_view> announced;
    std::optional<Time> rests_since;
    bool rests_displaced = false;
    bool is_uncertain = false;
    std::optional<Displacement> displacement;
  };
  struct Push {
    std::size_t pushing, pushed;
  };

  void displace(std::size_t robot, std::string_view cause, Time end);
  std::optional<std::string_view> excuse(std::optional<std::size_t> first,
                                         std::optional<std::size_t> second) const;
  void add_pair_time(Time now);
  void update_rest(std::size_t robot);
  void update_pushes();
  void update_displacement(std::size_t robot);
  bool has_rested(std::size_t robot, Time since) const;
  bool are_in_conflict(std::size_t a, std::size_t b) const;

  DisturbanceSettings settings_;
  std::optional<Time> now_;
  std::vector<std::optional<ObservedRobot>> robots_;
  std::vector<State> states_;
  std::vector<Push> pushes_;
  double pair_s_ = 0, excused_pair_s_ = 0;
};

/// The name of a cause of contacts; nullopt for an unknown kind.
[[nodiscard]] std::optional<std::string_view> cause_of(msg::DisturbanceKind kind);

}  // namespace sidestep
