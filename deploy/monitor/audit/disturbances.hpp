// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"
#include "idl/disturbance.hpp"

namespace sidestep {

/// A robot on the floor, as ground truth or vision shows it.
struct ObservedRobot {
  Vec2 position_m{0, 0};
  double speed_mps = 0;
  double inflation_m = 0;    ///< of the version that it executes
  bool is_in_place = false;  ///< where that version prescribes, and a ledger has held the version
};

struct DisturbanceSettings {
  double contact_distance_m = 0;  ///< robots farther apart do not touch
  double separation_m = 0;        ///< robots without inflation that are nearer are in conflict
  /// Motion that was granted before a disturbance became known ends within this time.
  Duration braking_time{0};
  bool knows_causes = true;  ///< every announcement of a cause is received
};

/// Decides which contacts disturbances of robots excuse. A contact of two robots is excused only if one of
/// them was disturbed, or was pushed by a disturbed robot. The excuse of a pair begins with the disturbance.
/// It ends when the disturbed robot is back in place, at rest or in motion, the other one has rested since
/// then, and the two are not in conflict. Robots are given by their index in the roster; times are those of
/// ground truth or vision.
class Disturbances {
 public:
  static constexpr std::string_view kUnknownCause = "unknown";
  static constexpr std::string_view kClockCause = "clock";

  Disturbances(std::size_t robots, const DisturbanceSettings& settings);

  /// An operator's message names the cause of a disturbance. By itself it excuses nothing.
  void announce(std::size_t robot, std::string_view cause);
  /// The robot is disturbed until `end`; Time::max(): the end is not known. Repetitions count once.
  void disturb(std::size_t robot, Time end, Time now);
  /// A contact began; nullopt stands for anything but a robot. Returns its cause if it is excused. A robot
  /// that a disturbed one pushes counts as disturbed by the same cause, for as long as they touch.
  [[nodiscard]] std::optional<std::string_view> on_contact(std::optional<std::size_t> first,
                                                           std::optional<std::size_t> second, Time now);
  /// The robots on the floor at this time.
  void update(Time now, const std::vector<std::optional<ObservedRobot>>& robots);

  /// Messages were missed: from now on it is not known when a robot that is disturbed now will be back.
  void on_missed();
  /// The same of messages that show positions.
  void on_reference_missed();
  /// Whether the robot may be disturbed although nothing that was received says so.
  bool is_uncertain(std::size_t robot) const { return states_[robot].is_uncertain; }
  /// Whether the robot was disturbed and is not back in place.
  bool is_displaced(std::size_t robot) const;
  /// Whether the robot rests, out of place, where a disturbance has left it. Without observations that it can
  /// use it never learns that, however long ago it was.
  bool rests_where_left(std::size_t robot) const { return states_[robot].rests_where_left; }
  /// Whether the robot was ever disturbed.
  bool was_disturbed(std::size_t robot) const { return states_[robot].reported_end.has_value(); }
  /// Sum over all pairs of robots on the floor of the observed time, and of the part of it in which a contact
  /// of the pair would have been excused.
  double pair_s() const { return pair_s_; }
  double excused_pair_s() const { return excused_pair_s_; }

 private:
  struct Displacement {
    std::string_view cause;
    Time end{};  ///< of the disturbance
    std::optional<Time> back_at;
    std::vector<bool> is_over;  ///< by robot: contacts with it are no longer excused
  };
  struct State {
    std::optional<Time> reported_end;  ///< as last reported
    std::optional<std::string_view> announced;
    std::optional<Time> rests_since;
    bool rests_where_left = false;
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
