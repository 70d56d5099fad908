// SPDX-License-Identifier: Apache-2.0
#pragma once

// Compiled once for each instruction set: nothing here may be an inline function that linkers merge.
#include <cstddef>
#include <cstdint>

namespace sidestep::batch {

inline constexpr std::size_t kLanes = 8;  ///< of a block, whatever the machine's vectors hold
inline constexpr std::size_t kSteps = 8;  ///< into which a comparison divides its time
inline constexpr std::size_t kSamples = kSteps + 1;

/// A number for each of a block's lanes.
struct alignas(64) Row {
  double lane[kLanes];
};

/// Motions of two phases and a rest each.
struct MotionBlock {
  Row start_s;
  Row first_s, x_m, y_m, vx_mps, vy_mps, half_ax, half_ay;
  Row second_s, second_vx, second_vy, second_half_ax, second_half_ay;
};

/// Where motions are at kSamples times, equally far apart.
struct TrackBlock {
  Row x_m[kSamples], y_m[kSamples];
};
struct Track {
  double x_m[kSamples], y_m[kSamples];
};

/// What each lane brings to a comparison. What happens before `start_s` does not count.
struct KeepBlock {
  Row start_s, min_separation_m, acceleration_mps2;
};

/// What a comparison decides by: chords of the relative motion are farther apart than the distance to keep
/// and `clear_room_m`, or come nearer than it less `blocked_room_m`; both also have room for how far the
/// motion may be from its chords.
struct ComparisonSettings {
  double begin_s, step_s;    ///< when the comparison begins, on the lanes' clock
  double acceleration_mps2;  ///< of the one that all are compared with
  double clear_room_m, blocked_room_m;
};

/// The decisions, summed up over comparisons: clear where `clear` >= 0, in the way where `blocked` < 0.
struct GapBlock {
  Row clear, blocked;
};

/// Accelerations and how far they are from the wished one, squared; infinitely far: not to be chosen.
struct AccelerationBlock {
  Row x, y, distance2;
};

/// The state from which accelerations are held, the limits, and the wish.
struct LimitSettings {
  double forward_x, forward_y;  ///< the direction in which drawn accelerations lie ahead
  double vx_mps, vy_mps;
  bool is_at_rest;
  double inverse_acceleration2, inverse_deceleration2, inverse_speed;
  double speed_limit_mps, seconds, inverse_seconds;
  double desired_x, desired_y;
};

/// Accelerations that are held and followed by the stop manoeuvre.
struct StopSettings {
  double x_m, y_m, vx_mps, vy_mps, hold_s, deceleration_mps2;
};

/// Finding and comparing.
struct ComparingKernels {
  /// Sets bit k of a block's mask where the discs of lane k and of the query touch.
  void (*touching)(const Row* x_m, const Row* y_m, const Row* radius_m, std::size_t blocks, double x,
                   double y, double radius, std::uint8_t* masks);
  /// The latest time at which a motion rests, of those that rest by `latest_s`, or `earliest_s`; sets the
  /// bits of those that do not.
  double (*rest)(const MotionBlock* motions, std::size_t blocks, double earliest_s, double latest_s,
                 std::uint8_t* later);
  void (*sample)(const MotionBlock* motions, std::size_t blocks, double begin_s, double step_s,
                 TrackBlock* tracks);
  /// What `one` has to each lane; lowers the gaps to that if they are to be kept. `keeps` has one block for
  /// all or one for each.
  void (*compare)(const ComparisonSettings& settings, const Track& one, const TrackBlock* lanes,
                  const KeepBlock* keeps, bool one_for_all, std::size_t blocks, bool keep_gaps,
                  GapBlock* gaps);
  /// Sets the bits of lanes that are clear, and of those in the way.
  void (*decide)(const GapBlock* gaps, std::size_t blocks, std::uint8_t* clear, std::uint8_t* blocked);
};

/// Drawing and choosing candidates. Every instruction set gives the same bits.
struct ChoosingKernels {
  /// Turns accelerations drawn in the frame of the velocity to the floor's, limits them (as limited() does)
  /// and measures their distances from the wish.
  void (*limit)(const LimitSettings& settings, AccelerationBlock* accelerations, std::size_t blocks);
  void (*stop)(const StopSettings& settings, const AccelerationBlock* accelerations, std::size_t blocks,
               MotionBlock* motions);
  /// Takes those within the spread of (x, y), and whatever is blocked, out of the choice; returns the nearest
  /// that is left, or the number of lanes.
  std::size_t (*choose)(double x, double y, double spread2, AccelerationBlock* accelerations,
                        const GapBlock* gaps, std::size_t blocks);
};

inline constexpr std::size_t kPredictionSteps = 16;
inline constexpr double kPredictionStep_s = 0.1;
inline constexpr std::size_t kPredictionSamples = kPredictionSteps + 1;
/// As near to its way point a robot turns to its goal.
inline constexpr double kPassed_m = 0.2;

/// Looking ahead, which nobody relies on, is done in single precision.
inline constexpr std::size_t kPredictionLanes = 2 * kLanes;
struct alignas(64) PredictionRow {
  float lane[kPredictionLanes];
};

/// States, and what their robots mean to do: hold a velocity for so long, then make for a goal past a way
/// point.
struct CourseBlock {
  PredictionRow x_m, y_m, vx_mps, vy_mps;
  PredictionRow hold_vx, hold_vy, hold_s;
  PredictionRow way_x, way_y, goal_x, goal_y;
};

/// Where robots are expected at the ends of steps, and when each has come to its goal.
struct PredictionBlock {
  PredictionRow x_m[kPredictionSamples], y_m[kPredictionSamples];
  PredictionRow arrival_s;
};
/// One robot's.
struct Prediction {
  float x_m[kPredictionSamples], y_m[kPredictionSamples];
};

/// What robots can do.
struct DrivingSettings {
  float speed_mps, acceleration_mps2, deceleration_mps2;
};

/// Looking ahead. Every instruction set gives the same bits.
struct PredictionKernels {
  void (*drive)(const DrivingSettings& settings, const CourseBlock* courses, std::size_t blocks,
                PredictionBlock* forecasts);
  /// Adds, for each step after the sample `from` in which a lane comes nearer to `one` than `min_separation_m`, the
  /// step's weight times the square of 1 - (distance / min_separation_m)²; steps that end later than `after_s` after a
  /// lane's arrival do not count.
  void (*meet)(const Prediction& one, std::size_t from, float min_separation_m, const float* weights, float after_s,
               const PredictionBlock* lanes, std::size_t blocks, PredictionRow* dangers);
  /// The same for each sample outside a rectangle about the origin, once its weight for each `deep_m`
  /// outside.
  void (*leave)(float half_length_m, float half_width_m, float deep_m, const float* weights,
                const PredictionBlock* lanes, std::size_t blocks, PredictionRow* dangers);
};

/// The inner loops of safety layer and steering for one instruction set.
struct Kernels {
  const char* name;
  ComparingKernels comparing;
  ChoosingKernels choosing;
  PredictionKernels forecasting;
};

}  // namespace sidestep::batch
