// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/batch/dispatch.hpp"
#include "agents/batch/lanes.hpp"
#include "common/motion/limits.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The accelerations that a search chooses from, eight to a block: drawn, compared with those who may be in
/// the way, and taken out in the order of their distance from the wish.
class CandidateChoice {
 public:
  CandidateChoice(int samples, const MotionLimits& limits, const batch::Kernels& kernels);

  /// The wish, which has to obey the limits, and random ones from A(v), limited to what may be held for the
  /// phase.
  void draw(const Vec2& velocity_mps, const Vec2& desired_mps2, Duration phase, Rng& rng);
  /// Prepares for compare(): every one is held from the state on for the phase, then the robot stops.
  void sample(const State& at_start, double phase_s, double step_s);
  /// Takes out what certainly comes nearer than `min_separation_m` to the other, who begins at `start_s`.
  void compare(const batch::Track& other, double start_s, double min_separation_m, double other_acceleration_mps2);

  /// Takes the nearest to the wish that is left out of the choice, and those too near to the one chosen last.
  std::optional<std::size_t> take_nearest(double spread_mps2);
  /// The one that was taken last is chosen: those near to it are no choice any more.
  void keep(std::size_t index) { last_kept_ = index; }

  Vec2 acceleration(std::size_t index) const;
  bool is_certainly_clear(std::size_t index) const;
  std::size_t size() const { return count_; }

 private:
  const batch::Kernels* kernels_;
  MotionLimits limits_;
  std::size_t count_;
  std::vector<double> drawn_x_, drawn_y_;
  std::vector<batch::AccelerationBlock> accelerations_;
  std::vector<batch::MotionBlock> motions_;
  std::vector<batch::TrackBlock> tracks_;
  std::vector<batch::GapBlock> gaps_;
  double step_s_ = 0;
  std::optional<std::size_t> last_kept_;
};

}  // namespace sidestep
