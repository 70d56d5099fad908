// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/safety_search.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {

Trajectory accelerate_then_stop(Time start, const State& at_start, const Vec2& acceleration,
                                Duration hold_time, double deceleration) {
  Trajectory trajectory(start, at_start);
  trajectory.append(hold_time, acceleration);
  append_stop(trajectory, deceleration);
  return trajectory;
}

namespace {

// Covers rounding errors.
constexpr double kRoundingFactor = 1.001;

double max_acceleration_mps2(const MotionLimits& limits) {
  return kRoundingFactor * std::max(limits.acceleration_mps2, limits.deceleration_mps2);
}

/// Upper bound of the time that a candidate needs to stop after its acceleration has been held.
double max_stop_s(const SearchQuery& query, const MotionLimits& limits) {
  const double speed = query.at_start.velocity_mps.norm();
  const double gained = max_acceleration_mps2(limits) * to_seconds(query.hold_time);
  return kRoundingFactor * std::min(std::max(limits.speed_mps, speed), speed + gained) /
         limits.deceleration_mps2;
}

/// Upper bound of the distance between two candidates per m/s² of difference between their accelerations.
/// They diverge while the accelerations are held. While both stop, their difference in velocity adds at most
/// its magnitude times the longer stopping time.
double deviation_per_mps2(const SearchQuery& query, const MotionLimits& limits) {
  const double hold_s = to_seconds(query.hold_time);
  return kRoundingFactor * hold_s * (0.5 * hold_s + max_stop_s(query, limits));
}

}  // namespace

bool SafetySearch::Other::is_clear(const Trajectory& candidate) const {
  return trajectory ? sidestep::is_clear(candidate, *trajectory, min_separation_m)
                    : sidestep::is_clear(candidate, *obstacle, min_separation_m);
}

SafetySearch::SafetySearch(const FloorRules& rules, const batch::Kernels& kernels)
    : rules_(rules), candidates_(kSamples, rules.limits, kernels), clearance_(kernels) {
  for (const Shape& obstacle : rules.obstacles)
    obstacles_.push_back(trajectory_bounds(Trajectory::resting(Time{}, centre_m(obstacle))));
  constexpr std::size_t kTypicalCount = 64;
  found_indices_.reserve(kTypicalCount);
  others_.reserve(kTypicalCount);
  preferred_.reserve(kTypicalCount);
  nearby_.reserve(kTypicalCount);
  exact_.reserve(kTypicalCount);
  edges_.reserve(kTypicalCount);
  cells_.reserve(kTypicalCount);
  constexpr std::size_t kTypicalMovingCount = 512;
  moving_.reserve(kTypicalMovingCount);
}

SearchResult SafetySearch::search(const SearchQuery& query, TrajectoryIndex& others, Rng& rng) {
  const MotionLimits& limits = rules_.limits;
  const MotionLimits limited = query.limited(limits);
  const Vec2 desired =
      limit_acceleration(query.desired_mps2, query.at_start.velocity_mps, limited, query.hold_time);
  const TrajectoryBounds desired_bounds = trajectory_bounds(
      accelerate_then_stop(query.start, query.at_start, desired, query.hold_time, limits.deceleration_mps2));
  const double max_deviation_m =
      (desired.norm() + max_acceleration_mps2(limits)) * deviation_per_mps2(query, limits);

  const double min_separation_m = rules_.radius_m + rules_.margin_m;
  SearchResult result;
  candidates_.sample_accelerations(query.at_start.velocity_mps, desired, query.hold_time, limited.speed_mps,
                                   rng);
  preferred_.clear();
  for (const Vec2& preferred : query.preferred_mps2)
    preferred_.push_back(
        limit_acceleration(preferred, query.at_start.velocity_mps, limited, query.hold_time));
  candidates_.prefer(preferred_);
  const Circle disc{desired_bounds.disc.centre_m, desired_bounds.disc.radius_m + max_deviation_m};
  find_nearby(query, disc, others);
  find_moving(query, disc);
  find_hidden(query, disc);
  HiddenSpace hidden = query.hidden;
  hidden.frontiers = frontiers_;
  hidden.closed_gaps = closed_gaps_;
  keep_out_.find(query.keep_outs, query.at_start.position_m, query.way_out_m, disc, rules_.radius_m);
  compare(query, desired_bounds, max_deviation_m, result.checks);
  const UncontrolledBodies uncontrolled(query.uncontrolled, query.stop, query.start);
  while (const auto index = candidates_.take_nearest(kSpread_mps2)) {
    const Trajectory trajectory =
        accelerate_then_stop(query.start, query.at_start, candidates_.acceleration(*index), query.hold_time,
                             limits.deceleration_mps2);
    if (!is_allowed(trajectory, candidates_.is_certainly_clear(*index))) continue;
    if (!uncontrolled.allow(trajectory, min_separation_m, limits.deceleration_mps2)) continue;
    if (!is_passively_safe_from_all(trajectory, moving_, min_separation_m, query.creep_mps)) continue;
    if (!is_passively_safe_from_unseen(trajectory, query.seen, min_separation_m)) continue;
    if (!is_passively_safe_from_hidden(trajectory, hidden, min_separation_m)) continue;
    if (!keep_out_.allows(trajectory)) continue;
    candidates_.accept(*index);
    result.desired_is_clear = result.desired_is_clear || *index == 0;
    result.candidates[result.count++] = trajectory;
    if (result.count == SearchResult::kMaxCandidates) break;
  }
  return result;
}

void SafetySearch::find_nearby(const SearchQuery& query, const Circle& disc, TrajectoryIndex& others) {
  clearance_.reset(query.start);
  others_.clear();
  const double separation = rules_.min_separation_m();
  // Covers the tolerance of computed clearances.
  constexpr double kRounding_m = 1e-6;
  found_indices_.clear();
  others.find({disc.centre_m, disc.radius_m + separation + kRounding_m}, found_indices_);
  for (const std::uint32_t index : found_indices_) {
    const Version& version = others.version(index);
    if (query.robot == version.robot) continue;
    clearance_.add(others.bounds(index), separation + version.inflation_m);
    others_.push_back({&version.trajectory, nullptr, separation + version.inflation_m});
  }
  edges_.clear();
  const double clearance = rules_.radius_m + rules_.margin_m;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const Shape& obstacle = rules_.obstacles[i];
    const auto* circle = std::get_if<Circle>(&obstacle);
    if (!circle) {
      if (signed_distance(disc.centre_m, obstacle) <= disc.radius_m + clearance + kRounding_m)
        edges_.push_back({nullptr, &obstacle, clearance});
      continue;
    }
    const double from_centre = circle->radius_m + clearance,
                 max_distance = disc.radius_m + from_centre + kRounding_m;
    if ((circle->centre_m - disc.centre_m).squaredNorm() > max_distance * max_distance) continue;
    TrajectoryBounds bounds = obstacles_[i];
    bounds.start = query.start;
    clearance_.add(bounds, from_centre);
    others_.push_back({nullptr, &obstacle, clearance});
  }
  find_cells({disc.centre_m, disc.radius_m + clearance + kRounding_m});
  for (const Shape& box : cells_) edges_.push_back({nullptr, &box, clearance});
  const double half_x = rules_.field.length_m / 2 - rules_.radius_m - disc.radius_m;
  const double half_y = rules_.field.width_m / 2 - rules_.radius_m - disc.radius_m;
  is_near_border_ = !(std::abs(disc.centre_m.x()) < half_x && std::abs(disc.centre_m.y()) < half_y);
}

void SafetySearch::find_cells(const Circle& disc) {
  cells_.clear();
  if (!rules_.map || rules_.map->field().lower_bound_m(disc.centre_m) > disc.radius_m) return;
  // If the length of the path is unknown, its disc is huge, and boxes of that size would lose all precision.
  constexpr double kMaxReach_m = 1e5;
  const Vec2 half_m = Vec2::Constant(std::min(disc.radius_m, kMaxReach_m));
  rules_.map->cells().for_each_box({disc.centre_m - half_m, disc.centre_m + half_m}, [&](const Box& box) {
    if (signed_distance(disc.centre_m, box) <= disc.radius_m) cells_.emplace_back(box);
    return true;
  });
}

void SafetySearch::find_moving(const SearchQuery& query, const Circle& disc) {
  constexpr double kRounding_m = 1e-6;
  const double separation = rules_.radius_m + rules_.margin_m + kRounding_m;
  const Time latest_end = query.start + query.hold_time + from_seconds(max_stop_s(query, rules_.limits));
  moving_.clear();
  for (const MovingObstacle& obstacle : query.moving) {
    const double reach = std::max(obstacle.reach_m(query.start), obstacle.reach_m(latest_end));
    if (touch(disc, {obstacle.position_m, reach + separation})) moving_.push_back(obstacle);
  }
}

void SafetySearch::find_hidden(const SearchQuery& query, const Circle& disc) {
  constexpr double kTolerance_m = 0.01;  // exceeds the tolerance of the check
  const HiddenSpace& hidden = query.hidden;
  const Time latest_end = query.start + query.hold_time + from_seconds(max_stop_s(query, rules_.limits));
  const double turned_m =
      hidden.heading_error_rad * ((disc.centre_m - hidden.observed_from_m).norm() + disc.radius_m);
  const double reach_m = disc.radius_m + rules_.radius_m + rules_.margin_m + turned_m +
                         hidden.speed_mps * std::abs(to_seconds(latest_end - hidden.observed_at)) +
                         kTolerance_m;
  const auto find = [&](std::span<const Frontier> all, std::vector<Frontier>& near) {
    near.clear();
    for (const Frontier& frontier : all) {
      const double within_m = reach_m + frontier.bulge_m;
      if (squared_distance(disc.centre_m, frontier.segment) <= within_m * within_m) near.push_back(frontier);
    }
  };
  find(hidden.frontiers, frontiers_);
  find(hidden.closed_gaps, closed_gaps_);
}

/// All candidates stay within `extra_clearance_m` of the desired motion. A neighbour that is clear of the
/// desired motion by that distance is therefore clear of all candidates. Each candidate is compared only with
/// the other neighbours.
void SafetySearch::compare(const SearchQuery& query, const TrajectoryBounds& desired,
                           double extra_clearance_m, int& checks) {
  const double hold_s = to_seconds(query.hold_time);
  const double seconds = hold_s + max_stop_s(query, rules_.limits);
  if (!desired.is_batchable || seconds > batch::kMaxHorizon_s) {
    nearby_ = exact_ = others_;
    return;
  }
  exact_.clear();
  nearby_.clear();
  if (others_.empty()) return;
  clearance_.sample(query.start, seconds);
  clearance_.compare(batch::track_of(desired, query.start, clearance_.step_s()), desired.acceleration_mps2,
                     extra_clearance_m);
  checks += static_cast<int>(clearance_.size());
  if (clearance_.are_all_clear()) return;
  bool is_sampled = false;
  for (std::size_t lane = 0; lane < clearance_.size(); ++lane) {
    if (clearance_.needs_exact(lane)) {
      exact_.push_back(others_[lane]);
      nearby_.push_back(others_[lane]);
    } else if (!clearance_.is_clear(lane)) {
      if (!is_sampled) candidates_.sample_motions(query.at_start, hold_s, clearance_.step_s());
      is_sampled = true;
      candidates_.compare(clearance_.track(lane), clearance_.start_s(lane), clearance_.min_separation_m(lane),
                          clearance_.acceleration_mps2(lane));
      checks += static_cast<int>(candidates_.size());
      nearby_.push_back(others_[lane]);
    }
  }
}

bool SafetySearch::is_allowed(const Trajectory& trajectory, bool is_certainly_clear) const {
  if (is_near_border_ && !stays_on(rules_.field, rules_.radius_m, trajectory)) return false;
  const auto is_clear = [&](const Other& other) { return other.is_clear(trajectory); };
  return std::ranges::all_of(is_certainly_clear ? exact_ : nearby_, is_clear) &&
         std::ranges::all_of(edges_, is_clear);
}

}  // namespace sidestep
