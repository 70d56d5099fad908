// SPDX-License-Identifier: Apache-2.0
#pragma once

// Included by sources compiled for different instruction sets: this header must not contain inline functions,
// because the linker would merge their copies.
#include <cstddef>
#include <cstdint>

namespace sidestep::batch {

inline constexpr std::size_t kLanes = 8;  ///< lanes per block, independent of the machine's vector width
inline constexpr std::size_t kSteps = 8;  ///< number of steps into which a comparison divides its time span
inline constexpr std::size_t kSamples = kSteps + 1;

/// One number for each lane of a block.
struct alignas(64) Row {
  double lane[kLanes];
};

/// Motions with two phases of constant acceleration, followed by rest.
struct MotionBlock {
  Row start_s;
  Row first_s, x_m, y_m, vx_mps, vy_mps, half_ax, half_ay;
  Row second_s, second_vx, second_vy, second_half_ax, second_half_ay;
};

/// Positions of motions at kSamples equidistant times.
struct TrackBlock {
  Row x_m[kSamples], y_m[kSamples];
};
/// Positions of a single motion.
struct Track {
  double x_m[kSamples], y_m[kSamples];
};

/// Per-lane inputs of a comparison. Times before `start_s` are ignored. `acceleration_mps2` is the upper
/// bound of the lane's acceleration.
struct SeparationBlock {
  Row start_s, min_separation_m, acceleration_mps2;
};

/// Thresholds of a comparison. A lane is clear if all chords of the relative motion stay farther away than
/// the minimum separation plus `clear_slack_m`. It is blocked if a chord comes nearer than the minimum
/// separation minus `blocked_slack_m`. Both tests also allow for the largest deviation of the motion from its
/// chords.
struct ComparisonSettings {
  double begin_s, step_s;    ///< start and step, on the lanes' time axis
  double acceleration_mps2;  ///< upper bound of the reference motion's acceleration
  double clear_slack_m, blocked_slack_m;
};

/// Results accumulated over comparisons: a lane is clear where `clear` >= 0, and blocked where `blocked` < 0.
struct GapBlock {
  Row clear, blocked;
};

/// Accelerations and their squared distances from the desired acceleration. Infinite distances exclude lanes.
struct AccelerationBlock {
  Row x, y, distance2;
};

/// The state in which the accelerations start, the motion limits, and the desired acceleration.
struct LimitSettings {
  double forward_x, forward_y;  ///< x axis of the frame in which accelerations are sampled
  double vx_mps, vy_mps;
  bool is_at_rest;
  double inverse_acceleration2, inverse_deceleration2, inverse_speed;
  double speed_limit_mps, seconds, inverse_seconds;
  double desired_x, desired_y;
};

/// The state in which the accelerations start, how long they are held, and the deceleration of the subsequent
/// stop.
struct StopSettings {
  double x_m, y_m, vx_mps, vy_mps, hold_s, deceleration_mps2;
};

/// Kernels that compare discs and motions.
struct ComparisonKernels {
  /// Sets bit k of a block's mask if the discs of lane k and of the query touch.
  void (*find_touching)(const Row* x_m, const Row* y_m, const Row* radius_m, std::size_t blocks, double x,
                        double y, double radius, std::uint8_t* masks);
  /// Returns the latest time at which a motion comes to rest, among the motions that rest by `latest_s`, but
  /// at least `earliest_s`. Sets the bits of motions that rest later than `latest_s`.
  double (*find_rest)(const MotionBlock* motions, std::size_t blocks, double earliest_s, double latest_s,
                      std::uint8_t* later);
  void (*sample)(const MotionBlock* motions, std::size_t blocks, double begin_s, double step_s,
                 TrackBlock* tracks);
  /// Computes the gaps between `reference` and each lane. With `accumulate`, existing gaps are lowered to the
  /// new gaps if those are smaller; otherwise existing gaps are overwritten. `separations` has one block per
  /// block of lanes, or a single block if `is_shared`.
  void (*compare)(const ComparisonSettings& settings, const Track& reference, const TrackBlock* lanes,
                  const SeparationBlock* separations, bool is_shared, std::size_t blocks, bool accumulate,
                  GapBlock* gaps);
  /// Sets the bits of clear lanes and of blocked lanes.
  void (*decide)(const GapBlock* gaps, std::size_t blocks, std::uint8_t* clear, std::uint8_t* blocked);
};

/// Kernels that limit, expand and choose candidate accelerations. All instruction sets give bit-identical
/// results.
struct ChoiceKernels {
  /// Rotates accelerations from the velocity's frame to the field's, limits them as limit_acceleration()
  /// does, and computes their squared distances from the desired acceleration.
  void (*limit)(const LimitSettings& settings, AccelerationBlock* accelerations, std::size_t blocks);
  /// Builds the motions that hold each acceleration and then stop.
  void (*stop)(const StopSettings& settings, const AccelerationBlock* accelerations, std::size_t blocks,
               MotionBlock* motions);
  /// Excludes accelerations whose squared distance from (x, y) is below `spread2`, and blocked accelerations.
  /// Returns the remaining lane nearest to the desired acceleration, or the number of lanes if none remains.
  std::size_t (*choose)(double x, double y, double spread2, AccelerationBlock* accelerations,
                        const GapBlock* gaps, std::size_t blocks);
};

inline constexpr std::size_t kPredictionSteps = 16;
inline constexpr double kPredictionStep_s = 0.1;
inline constexpr std::size_t kPredictionSamples = kPredictionSteps + 1;
/// Distance from its waypoint at which a robot turns towards its goal.
inline constexpr double kWaypointRadius_m = 0.2;

/// Predictions use single precision: safety does not depend on them.
inline constexpr std::size_t kPredictionLanes = 2 * kLanes;
struct alignas(64) PredictionRow {
  float lane[kPredictionLanes];
};

/// States and intents of robots. Each robot holds its intent's velocity for `velocity_duration_s`, then heads
/// for its goal by way of the waypoint.
struct CourseBlock {
  PredictionRow x_m, y_m, vx_mps, vy_mps;
  PredictionRow intent_vx, intent_vy, velocity_duration_s;
  PredictionRow waypoint_x, waypoint_y, goal_x, goal_y;
};

/// Predicted positions at the ends of the steps, and predicted arrival times at the goals.
struct PredictionBlock {
  PredictionRow x_m[kPredictionSamples], y_m[kPredictionSamples];
  PredictionRow arrival_s;
};
/// Predicted positions of a single robot.
struct Prediction {
  float x_m[kPredictionSamples], y_m[kPredictionSamples];
};

/// Motion limits of the predicted robots.
struct DrivingSettings {
  float speed_mps, acceleration_mps2, deceleration_mps2;
};

/// Kernels that predict motions and rate them. All instruction sets give bit-identical results.
struct PredictionKernels {
  void (*roll_out)(const DrivingSettings& settings, const CourseBlock* courses, std::size_t blocks,
                   PredictionBlock* predictions);
  /// For each step after sample `from` in which a lane comes nearer to `reference` than `min_separation_m`,
  /// adds the step's weight times (1 - (distance / min_separation_m)²)². Ignores steps that end more than
  /// `after_arrival_s` after the lane's arrival.
  void (*add_proximity_danger)(const Prediction& reference, std::size_t from, float min_separation_m,
                               const float* weights, float after_arrival_s, const PredictionBlock* lanes,
                               std::size_t blocks, PredictionRow* dangers);
  /// For each sample outside a rectangle centred on the origin, adds the sample's weight times the smaller of
  /// 1 and distance outside / `full_danger_m`.
  void (*add_outside_danger)(float half_length_m, float half_width_m, float full_danger_m,
                             const float* weights, const PredictionBlock* lanes, std::size_t blocks,
                             PredictionRow* dangers);
};

/// Inner loops of the safety search and of steering for one instruction set.
struct Kernels {
  const char* name;
  ComparisonKernels comparison;
  ChoiceKernels choice;
  PredictionKernels prediction;
};

}  // namespace sidestep::batch
