// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "agents/safety/safety_search.hpp"
#include "common/protocol/order.hpp"

namespace sidestep {

/// Finds out whether an opponent or a person keeps a robot from driving. Input: the result of each search.
/// Output: the stranger, once it has done so for a while. Strangers that stand beside a robot forbid every
/// motion but the slowest, because they may start to move at any time.
class StrangerWatch {
 public:
  /// `rules` must outlive this object.
  explicit StrangerWatch(const FloorRules& rules) : rules_(rules) {}

  /// Processes the result of a search. `is_free`: the robot got its desired motion.
  void update(const SearchQuery& query, bool is_free, Time now);
  /// Forgets a stranger that has not stopped the robot for a while, or if the robot's clock was set back.
  /// Call it once per cycle.
  void close_cycle(Time now);
  /// Whether a stranger stops the robot who is so near to this goal that the robot can hardly rest there.
  /// Then other ways do not help.
  bool is_at(const Vec2& goal_m) const;
  /// The stranger that keeps the robot from driving, and the robot's place; nullopt if there is none.
  std::optional<Blockage> lasting() const;

 private:
  const FloorRules& rules_;
  std::optional<Blockage> stranger_;
  Time since_{}, last_{};  // when a stranger stopped the robot first and last
};

}  // namespace sidestep
