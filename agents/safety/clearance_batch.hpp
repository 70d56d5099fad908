// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agents/batch/dispatch.hpp"
#include "agents/batch/lanes.hpp"

namespace sidestep {

/// Compares one trajectory with many at a time: is_clear() for each of them, decided as is_clear() decides,
/// but most of it several to an instruction. Cheapest where several, one after the other, begin at the same
/// time and are compared with the same many. Allocates nothing once warm.
class ClearanceBatch {
 public:
  explicit ClearanceBatch(const batch::Kernels& kernels = batch::best_kernels()) : lanes_(kernels) {}

  /// Forgets all that were added. What will be compared begins about `base`.
  void restart(Time base);
  std::size_t size() const { return others_.size(); }
  /// The trajectory, whose outline it is, is read until the next restart().
  void add(const TrajectoryBounds& outline, const Trajectory& trajectory, double min_separation_m);

  /// For each that was added, in that order: is_clear(one, trajectory, min_separation_m).
  std::span<const std::uint8_t> compare(const Trajectory& one);

  /// How many pairs had to be left to is_clear() so far.
  std::uint64_t left_to_exact() const { return left_to_exact_; }

 private:
  struct Other {
    const Trajectory* trajectory;
    double min_separation_m;
  };
  bool exact(const Trajectory& one, const Other& other);

  batch::Lanes lanes_;
  std::vector<Other> others_;  // as the lanes
  std::vector<std::uint8_t> clear_;
  std::uint64_t left_to_exact_ = 0;
};

}  // namespace sidestep
