// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Whom somebody has moved, and whom those push who were moved: what they touch, and where they are, is not
/// the protocol's doing. Robots by their places in the roster; times are the simulator's.
class Hands {
 public:
  /// Who does not see whether robots are back in their places takes them to be after a while.
  Hands(std::size_t robots, bool sees_places);

  /// A ground truth of now says that somebody has moved a robot, and lets go of it then. Said again and
  /// again, it counts once.
  void move(std::size_t robot, Time let_go, Time now);
  /// Another ground truth: where robots are; nothing for a robot that is not in it. Those that touch are not
  /// farther apart than `touching_m`.
  void step(Time now, const std::vector<std::optional<Vec2>>& places_m, double touching_m);
  /// Two robots began to touch; nothing: what is no robot. Whether one of them was moved: then it pushes the
  /// other one, for as long as they touch.
  bool touch(std::optional<std::size_t> first, std::optional<std::size_t> second);
  /// A robot is where it ought to be.
  void see_in_place(std::size_t robot);

  bool are_on(std::size_t robot) const { return held_[robot].until.has_value(); }

 private:
  struct Held {
    std::optional<Time> let_go;  ///< as told last
    std::optional<Time> until;   ///< before it nobody can say that the robot is back in its place
  };
  struct Push {
    std::size_t by, of;
  };
  void hold(std::size_t robot, Time let_go);

  bool sees_places_;
  Time now_{};
  std::vector<Held> held_;
  std::vector<Push> pushes_;
};

}  // namespace sidestep
