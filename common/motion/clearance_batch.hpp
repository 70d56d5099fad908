// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/motion/batch/dispatch.hpp"
#include "common/motion/batch/lanes.hpp"

namespace sidestep {

/// Compares one trajectory with many at a time: is_clear() for each of them, decided as is_clear() decides,
/// but most of it several to an instruction. Allocates nothing once warm.
class ClearanceBatch {
 public:
  explicit ClearanceBatch(const batch::Kernels& kernels = batch::best_kernels()) : kernels_(&kernels) {}

  void clear() { others_.clear(); }
  std::size_t size() const { return others_.size(); }
  /// Both are read until clear(). `outline` is the trajectory's.
  void add(const Outline& outline, const Trajectory& trajectory, double keep_m) {
    others_.push_back({&outline, &trajectory, keep_m});
  }

  /// For each that was added, in that order: is_clear(one, trajectory, keep_m).
  std::span<const std::uint8_t> compare(const Trajectory& one);

  /// How many pairs had to be left to is_clear() so far.
  std::uint64_t left_to_exact() const { return left_to_exact_; }

 private:
  struct Other {
    const Outline* outline;
    const Trajectory* trajectory;
    double keep_m;
  };
  bool exact(const Trajectory& one, const Other& other);

  const batch::Kernels* kernels_;
  std::vector<Other> others_;
  std::vector<std::size_t> plain_;  // of others_, in the lanes' order
  std::vector<std::uint8_t> clear_;
  batch::Lanes lanes_, self_;
  std::uint64_t left_to_exact_ = 0;
};

}  // namespace sidestep
