// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Whom somebody has moved, and whom those push who were moved: what they touch, and where they are, is not
/// the protocol's doing. Robots by their places in the roster.
class Hands {
 public:
  /// `period`: of ground truths. Who does not see whether robots are back in their places takes them to be
  /// after a while.
  Hands(std::size_t robots, Duration period, bool sees_places);

  /// Somebody moves a robot, for so long.
  void move(std::size_t robot, Duration lasts);
  /// Two robots begin to touch; nothing: what is no robot. Whether one of them was moved: then it pushes the
  /// other one, for as long as they touch.
  bool touch(std::optional<std::size_t> first, std::optional<std::size_t> second);
  /// Another ground truth: where robots are; nothing for a robot that is not in it. Those that touch are not
  /// farther apart than `touching_m`.
  void step(const std::vector<std::optional<Vec2>>& places_m, double touching_m);
  /// A robot is where it ought to be.
  void see_in_place(std::size_t robot);

  bool are_on(std::size_t robot) const { return left_[robot].has_value(); }

 private:
  struct Push {
    std::size_t by, of;
  };
  void begin(std::size_t robot, Duration lasts);

  Duration period_;
  bool sees_places_;
  std::vector<std::optional<std::int64_t>> left_;  ///< so many ground truths more before it may be in place
  std::vector<Push> pushes_;
};

}  // namespace sidestep
