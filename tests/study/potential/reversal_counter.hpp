// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// Counts how often a path changes between turning left and turning right. A reversal is a turn back by more
/// than `threshold_rad` from the extreme heading since the last reversal.
class ReversalCounter {
 public:
  explicit ReversalCounter(double threshold_rad) : threshold_rad_(threshold_rad) {}

  /// Adds the next position. Motions shorter than a millimetre have no heading and are ignored.
  void add(const Vec2& position_m);
  int reversals() const { return reversals_; }
  double length_m() const { return length_m_; }

 private:
  void add_heading(double heading_rad);

  double threshold_rad_;
  std::optional<Vec2> last_m_;
  std::optional<double> heading_rad_;  // continuous: may exceed [-pi, pi]
  double min_rad_ = 0, max_rad_ = 0;   // extreme headings since the last reversal
  int turning_ = 0;                    // 1: left, -1: right, 0: unknown
  int reversals_ = 0;
  double length_m_ = 0;
};

}  // namespace sidestep
