// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "agents/navigation/motion_predictor.hpp"
#include "common/geometry/field.hpp"

namespace sidestep {

/// A robot's previous choice.
struct LastChoice {
  std::optional<Intent> detour;  ///< a velocity that is held, or a via point; nullopt: the direct path
  std::uint64_t changes = 0;     ///< number of choices that did not continue the previous choice
};

/// Chooses a robot's intent among other robots. The direct path is chosen if it is predicted to be free.
/// Otherwise candidate detours (velocities held for some time, and via points) are predicted together with
/// the other robots' intents. They are compared by time to goal and by danger, that is, how near they come to
/// others and how soon. The choice is published as the robot's own intent. Safety does not depend on it. Does
/// not allocate once warm.
class Steering {
 public:
  Steering(const Field& field, double radius_m, const MotionLimits& limits,
           const batch::Kernels& kernels = batch::best_kernels());

  /// Forgets the other robots and obstacles.
  void clear();
  /// Adds a moving robot to yield to. The distance between the centres should be at least `min_separation_m`.
  void add_moving(const State& state, const Intent& intent, double min_separation_m);
  /// Adds a stationary robot or obstacle.
  void add_stationary(const Vec2& position_m, double min_separation_m);

  /// Chooses the intent from a given state on. `elapsed_s` is the time since the state of the last choice.
  /// Updates `last`: the last choice is kept unless another is better by more than the switch penalty.
  [[nodiscard]] Intent choose(const State& at, const Vec2& waypoint_m, const Vec2& goal_m, double elapsed_s,
                              LastChoice& last);

 private:
  struct Other {
    batch::Prediction prediction;
    double min_separation_m;
  };
  void predict_others();
  void add_candidate(const State& at, const Intent& intent, double extra_s = 0);
  void add_last_choice(const State& at, const Vec2& waypoint, const Vec2& goal, double elapsed_s,
                       const LastChoice& last);
  void add_velocity_candidates(const State& at, const Intent& direct);
  void add_via_point_candidates(const State& at, const Vec2& goal);
  /// Predicts the candidates and computes their dangers.
  void evaluate(const Vec2& at_m);
  /// The prediction sample before which a robot that starts at `from_m` cannot meet `other`.
  std::size_t first_reachable_sample(const Other& other, const Vec2& from_m) const;

  double danger_s(std::size_t lane) const;
  /// The lane with the lowest cost.
  std::size_t best() const;

  const batch::Kernels* kernels_;
  double speed_mps_;
  float half_length_m_, half_width_m_;
  float weights_[batch::kPredictionSamples] = {};
  MotionPredictor moving_;
  std::vector<double> min_separations_m_;  // indexed by lane of moving_
  std::vector<Other> others_;
  MotionPredictor candidates_;
  std::vector<Intent> intents_;  // indexed by lane of candidates_
  std::vector<double> extra_s_;  // penalty besides time and danger, indexed by lane of candidates_
  std::vector<batch::PredictionRow> dangers_;
};

}  // namespace sidestep
