// SPDX-License-Identifier: Apache-2.0
// Choice kernels for one instruction set; see vectors.hpp. Their results are proposed, so every machine must
// compute the same bits. Multiplications and additions must therefore not be fused.
#include "agents/batch/vectors.hpp"
#include "common/motion/rest.hpp"

namespace sidestep::batch {
namespace {

void limit(const LimitSettings& s, AccelerationBlock* accelerations, std::size_t blocks) {
  const Vector one = broadcast(1), zero = broadcast(0);
  for (std::size_t block = 0; block < blocks; ++block) {
    AccelerationBlock& a = accelerations[block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector ahead = load(a.x, at), left = load(a.y, at);
      Vector x = ahead * s.forward_x - left * s.forward_y, y = ahead * s.forward_y + left * s.forward_x;
      const Vector after_x = s.vx_mps + s.seconds * x, after_y = s.vy_mps + s.seconds * y;
      const Vector speed2 = after_x * after_x + after_y * after_y;
      const Vector slowdown = s.speed_limit_mps / square_root(speed2);
      const auto too_fast = speed2 > broadcast(s.speed_limit_mps * s.speed_limit_mps);
      x = too_fast ? (after_x * slowdown - s.vx_mps) * s.inverse_seconds : x;
      y = too_fast ? (after_y * slowdown - s.vy_mps) * s.inverse_seconds : y;
      const Vector forward_effort2 = (x * x + y * y) * s.inverse_acceleration2;
      const Vector along = (x * s.vx_mps + y * s.vy_mps) * s.inverse_speed;
      const Vector across = (s.vx_mps * y - s.vy_mps * x) * s.inverse_speed;
      const Vector backward_effort2 =
          along * along * s.inverse_deceleration2 + across * across * s.inverse_acceleration2;
      const Vector effective_along = s.is_at_rest ? zero : along;
      const Vector effort2 = effective_along < zero ? backward_effort2 : forward_effort2;
      const Vector end_x = s.vx_mps + s.seconds * x, end_y = s.vy_mps + s.seconds * y;
      const Vector end_speed2 = end_x * end_x + end_y * end_y;
      const Vector end_ahead = x * end_x + y * end_y, end_across = end_x * y - end_y * x;
      const Vector per_end_speed2 = one / end_speed2;
      const Vector braking_effort2 = end_ahead * end_ahead * per_end_speed2 * s.inverse_deceleration2 +
                                     end_across * end_across * per_end_speed2 * s.inverse_acceleration2;
      const Vector moving_effort2 = end_ahead < zero ? braking_effort2 : forward_effort2;
      const Vector end_effort2 =
          end_speed2 < broadcast(kPlannedRest_mps * kPlannedRest_mps) ? zero : moving_effort2;
      const Vector largest_effort2 = end_effort2 > effort2 ? end_effort2 : effort2;
      const Vector scale = largest_effort2 > one ? one / square_root(largest_effort2) : one;
      x = x * scale;
      y = y * scale;
      store(a.x, at, x);
      store(a.y, at, y);
      const Vector error_x = x - s.desired_x, error_y = y - s.desired_y;
      store(a.distance2, at, error_x * error_x + error_y * error_y);
    }
  }
}

void stop(const StopSettings& s, const AccelerationBlock* accelerations, std::size_t blocks,
          MotionBlock* motions) {
  constexpr double kNearlyAtRest_mps = 1e-9;
  for (std::size_t block = 0; block < blocks; ++block) {
    MotionBlock& m = motions[block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector ax = load(accelerations[block].x, at), ay = load(accelerations[block].y, at);
      const Vector vx = s.vx_mps + s.hold_s * ax, vy = s.vy_mps + s.hold_s * ay;
      const Vector speed = max(square_root(vx * vx + vy * vy), broadcast(kNearlyAtRest_mps));
      const Vector half_braking = (-0.5 * s.deceleration_mps2) / speed;
      store(m.start_s, at, broadcast(0));
      store(m.first_s, at, broadcast(s.hold_s));
      store(m.x_m, at, broadcast(s.x_m));
      store(m.y_m, at, broadcast(s.y_m));
      store(m.vx_mps, at, broadcast(s.vx_mps));
      store(m.vy_mps, at, broadcast(s.vy_mps));
      store(m.half_ax, at, 0.5 * ax);
      store(m.half_ay, at, 0.5 * ay);
      store(m.second_s, at, speed * (1 / s.deceleration_mps2));
      store(m.second_vx, at, vx);
      store(m.second_vy, at, vy);
      store(m.second_half_ax, at, vx * half_braking);
      store(m.second_half_ay, at, vy * half_braking);
    }
  }
}

std::size_t choose(double x, double y, double spread2, AccelerationBlock* accelerations, const GapBlock* gaps,
                   std::size_t blocks) {
  const Vector infinite = broadcast(kInfinity), zero = broadcast(0);
  Vector nearest = infinite, nearest_block = zero;
  for (std::size_t block = 0; block < blocks; ++block) {
    AccelerationBlock& a = accelerations[block];
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector dx = load(a.x, at) - x, dy = load(a.y, at) - y;
      Vector distance2 = load(a.distance2, at);
      distance2 = dx * dx + dy * dy < broadcast(spread2) ? infinite : distance2;
      distance2 = load(gaps[block].blocked, at) < zero ? infinite : distance2;
      store(a.distance2, at, distance2);
      const Vector here = broadcast(static_cast<double>(block * kLanes + at));
      nearest_block = distance2 < nearest ? here : nearest_block;
      nearest = min(distance2, nearest);
    }
  }
  double best = kInfinity;
  double best_lane = static_cast<double>(blocks * kLanes);
  for (std::size_t i = 0; i < kWidth; ++i) {
    const double lane = nearest_block[i] + static_cast<double>(i);
    if (nearest[i] < best || (nearest[i] == best && lane < best_lane && best < kInfinity)) {
      best = nearest[i];
      best_lane = lane;
    }
  }
  return static_cast<std::size_t>(best_lane);
}

}  // namespace

const ChoiceKernels SIDESTEP_KERNELS{limit, stop, choose};

}  // namespace sidestep::batch
