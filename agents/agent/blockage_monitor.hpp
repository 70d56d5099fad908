// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/protocol/order.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// What prevents a robot from reaching its goal, and since when. Input: once per cycle, whether the route
/// leads to the goal. Output: the blockage, once it has lasted long enough.
class BlockageMonitor {
 public:
  /// A blockage is reported if it lasts for at least `reported_after`.
  explicit BlockageMonitor(Duration reported_after) : reported_after_(reported_after) {}

  /// Call it when the goal can be reached, or has changed.
  void clear();
  void on_blocked(const Blockage& blockage, Time now);
  /// Restarts the timer, because the robot's clock was set back.
  void restart() { since_.reset(); }

  bool is_blocked() const { return since_.has_value(); }
  /// The blockage if it has lasted long enough; otherwise nullopt.
  std::optional<Blockage> lasting(Time now) const;

 private:
  Duration reported_after_;
  std::optional<Blockage> blockage_;
  std::optional<Time> since_;
};

}  // namespace sidestep
