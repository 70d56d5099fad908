// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/field.hpp"
#include "agents/navigation/motion_predictor.hpp"

namespace sidestep {

/// What is weighed against the seconds that a way takes.
struct SteeringSettings {
  double danger_s = 1;             ///< of being where another one is for one step of the forecast, now
  double late_danger = 0.08;       ///< as a share of it, at the end of the forecast
  double fade = 1.75;              ///< how quickly danger gets less with time
  double left_s = 0.16;            ///< of turning left: where both turn right they come past each other
  double change_s = 0.06;          ///< of going round in another way than was chosen last,
  double harmless_s = 0.02;        ///< which is not looked for while the danger of the last one is less
  double extra_clearance_m = 0.035;           ///< by so much more than they must, robots like to keep from each other,
  double standing_room_m = 0.016;  ///< and from what stands
};

/// What a robot chose last.
struct LastChoice {
  std::optional<Intent> way_round;  ///< a velocity that is held, or a bend
  std::uint64_t changes = 0;        ///< times that something else was chosen than to go on with it
};

/// Chooses what a robot makes for among others who move. As long as the straight way is free it is taken;
/// else ways round are driven in thought against what the others mean to do (their Intent), and weighed by
/// the time that they take and by how near they come to whom, how soon: velocities to hold for some time, and
/// bends to go past. Whoever has chosen says so to the others. Safety does not rest on it. Allocates nothing
/// once warm.
class Steering {
 public:
  Steering(const Field& field, double radius_m, const MotionLimits& limits,
           const SteeringSettings& settings = {}, const batch::Kernels& kernels = batch::best_kernels());

  /// Forgets the others.
  void clear();
  /// Somebody who moves, to make way for; centres are to stay `min_separation_m` apart.
  void add_moving(const State& state, const Intent& intent, double min_separation_m);
  /// Somebody or something that stays where it is.
  void add_standing(const Vec2& place_m, double min_separation_m);

  /// What to do from a state on. `since_s`: so much earlier was the state of the robot's last choice, which
  /// is kept unless something is gained by another one.
  Intent choose(const State& at, const Vec2& waypoint_m, const Vec2& goal_m, double since_s,
                LastChoice& last);

 private:
  struct Other {
    batch::Prediction forecast;
    double min_separation_m;
  };
  void forecast_others();
  void offer(const State& at, const Intent& intent, double extra_s = 0);
  void offer_last(const State& at, const Vec2& waypoint, const Vec2& goal, double since_s,
                  const LastChoice& last);
  void offer_turns(const State& at, const Intent& direct);
  void offer_bends(const State& at, const Vec2& goal);
  /// Drives what is offered in thought and finds how dangerous it is.
  void weigh(const Vec2& at_m);
  /// The sample before which a robot from here cannot meet another one.
  std::size_t first_reach(const Other& other, const Vec2& from_m) const;

  double danger_s(std::size_t lane) const;
  /// The lane with the least cost.
  std::size_t best() const;

  const batch::Kernels* kernels_;
  SteeringSettings settings_;
  double speed_mps_;
  float half_length_m_, half_width_m_;
  float weights_[batch::kPredictionSamples];
  MotionPredictor moving_;
  std::vector<double> keeps_m_;  // as moving_
  std::vector<Other> others_;
  MotionPredictor offered_;
  std::vector<Intent> intents_;  // as offered_, and what each costs besides time and danger
  std::vector<double> extra_s_;
  std::vector<batch::PredictionRow> dangers_;
};

}  // namespace sidestep
