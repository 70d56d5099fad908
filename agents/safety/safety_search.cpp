// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/safety_search.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {

Trajectory accelerate_then_stop(Time start, const State& at_start, const Vec2& acceleration, Duration phase,
                                double deceleration) {
  Trajectory trajectory(start, at_start);
  trajectory.append(phase, acceleration);
  append_stop(trajectory, deceleration);
  return trajectory;
}

namespace {

// A little more than computed, for rounding.
constexpr double kRoundedUp = 1.001;

double largest_acceleration_mps2(const MotionLimits& limits) {
  return kRoundedUp * std::max(limits.acceleration_mps2, limits.deceleration_mps2);
}

/// No candidate takes longer to stop, after its acceleration was held.
double longest_stop_s(const SearchQuery& query, const MotionLimits& limits) {
  const double speed = query.at_start.velocity_mps.norm();
  const double gained = largest_acceleration_mps2(limits) * to_seconds(query.phase);
  return kRoundedUp * std::min(std::max(limits.speed_mps, speed), speed + gained) / limits.deceleration_mps2;
}

/// How far two candidates can be apart, for each m/s² between their accelerations: they part while those are
/// held, and while both stop, a difference in velocity grows to at most the longer stop's time times itself.
double reach_per_mps2(const SearchQuery& query, const MotionLimits& limits) {
  const double hold_s = to_seconds(query.phase);
  return kRoundedUp * hold_s * (0.5 * hold_s + longest_stop_s(query, limits));
}

}  // namespace

bool SafetySearch::Other::is_clear(const Trajectory& candidate) const {
  return trajectory ? sidestep::is_clear(candidate, *trajectory, min_separation_m)
                    : sidestep::is_clear(candidate, centre_m, min_separation_m);
}

SafetySearch::SafetySearch(const FloorRules& rules, const SearchSettings& settings,
                           const batch::Kernels& kernels)
    : rules_(rules), settings_(settings), choice_(settings.samples, rules.limits, kernels), lanes_(kernels) {
  for (const Circle& obstacle : rules.obstacles)
    obstacles_.push_back(trajectory_bounds(Trajectory::resting(Time{}, obstacle.centre_m)));
  constexpr std::size_t kUsuallyEnough = 64;
  found_.reserve(kUsuallyEnough);
  others_.reserve(kUsuallyEnough);
  near_.reserve(kUsuallyEnough);
  exact_.reserve(kUsuallyEnough);
}

SearchResult SafetySearch::search(const SearchQuery& query, TrajectoryIndex& others, Rng& rng) {
  const MotionLimits& limits = rules_.limits;
  const Vec2 desired = limited(query.desired_mps2, query.at_start.velocity_mps, limits, query.phase);
  const TrajectoryBounds desired = trajectory_bounds(
      accelerate_then_stop(query.start, query.at_start, desired, query.phase, limits.deceleration_mps2));
  const double room = (desired.norm() + largest_acceleration_mps2(limits)) * reach_per_mps2(query, limits);

  SearchResult result;
  choice_.draw(query.at_start.velocity_mps, desired, query.phase, rng);
  find_near(query, {desired.disc.centre_m, desired.disc.radius_m + room}, others);
  compare(query, desired, room, result.checks);
  while (const auto index = choice_.take_nearest(settings_.spread_mps2)) {
    const Trajectory trajectory = accelerate_then_stop(
        query.start, query.at_start, choice_.acceleration(*index), query.phase, limits.deceleration_mps2);
    if (!is_allowed(trajectory, choice_.is_certainly_clear(*index))) continue;
    if (!rests_before_all(trajectory, query.moving, rules_.radius_m + rules_.margin_m + query.inflation_m))
      continue;
    choice_.keep(*index);
    result.desired_is_clear = result.desired_is_clear || *index == 0;
    result.candidates[result.count++] = trajectory;
    if (result.count == SearchResult::kMaxCandidates) break;
  }
  return result;
}

void SafetySearch::find_near(const SearchQuery& query, const Circle& disc, TrajectoryIndex& others) {
  lanes_.restart(query.start);
  others_.clear();
  const double keep = rules_.min_separation_m() + query.inflation_m;
  // Room for what clearances are computed to.
  constexpr double kRoom_m = 1e-6;
  found_.clear();
  others.find({disc.centre_m, disc.radius_m + keep + kRoom_m}, found_);
  for (const std::uint32_t index : found_) {
    const Version& version = others.version(index);
    if (query.robot == version.robot) continue;
    lanes_.add(others.outline(index), keep + version.inflation_m);
    others_.push_back({&version.trajectory, Vec2(0, 0), keep + version.inflation_m});
  }
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const Circle& obstacle = rules_.obstacles[i];
    const double clearance = obstacle.radius_m + rules_.radius_m + rules_.margin_m + query.inflation_m;
    const double far = disc.radius_m + clearance + kRoom_m;
    if ((obstacle.centre_m - disc.centre_m).squaredNorm() > far * far) continue;
    TrajectoryBounds outline = obstacles_[i];
    outline.start = query.start;
    lanes_.add(outline, clearance);
    others_.push_back({nullptr, obstacle.centre_m, clearance});
  }
  const double room_x = rules_.field.length_m / 2 - rules_.radius_m - disc.radius_m;
  const double room_y = rules_.field.width_m / 2 - rules_.radius_m - disc.radius_m;
  is_near_border_ = !(std::abs(disc.centre_m.x()) < room_x && std::abs(disc.centre_m.y()) < room_y);
}

/// All candidates are about where the wish leads, so whoever is clear of that by the room that they take is
/// clear of all of them. Only with the others who are near each candidate is compared.
void SafetySearch::compare(const SearchQuery& query, const TrajectoryBounds& desired, double extra_clearance_m, int& checks) {
  const double phase_s = to_seconds(query.phase);
  const double seconds = phase_s + longest_stop_s(query, rules_.limits);
  if (!desired.is_plain || seconds > batch::kLongest_s) {
    near_ = exact_ = others_;
    return;
  }
  exact_.clear();
  near_.clear();
  if (others_.empty()) return;
  lanes_.sample(query.start, seconds);
  lanes_.compare(batch::track_of(desired, query.start, lanes_.step_s()), desired.acceleration_mps2, extra_clearance_m);
  checks += static_cast<int>(lanes_.size());
  if (lanes_.are_all_clear()) return;
  bool is_sampled = false;
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
    if (lanes_.is_exact(lane)) {
      exact_.push_back(others_[lane]);
      near_.push_back(others_[lane]);
    } else if (!lanes_.is_clear(lane)) {
      if (!is_sampled) choice_.sample(query.at_start, phase_s, lanes_.step_s());
      is_sampled = true;
      choice_.compare(lanes_.track(lane), lanes_.start_s(lane), lanes_.min_separation_m(lane),
                      lanes_.acceleration_mps2(lane));
      checks += static_cast<int>(choice_.size());
      near_.push_back(others_[lane]);
    }
  }
}

bool SafetySearch::is_allowed(const Trajectory& trajectory, bool is_certainly_clear) const {
  if (is_near_border_ && !stays_on(rules_.field, rules_.radius_m, trajectory)) return false;
  const auto& in_question = is_certainly_clear ? exact_ : near_;
  return std::ranges::all_of(in_question, [&](const Other& other) { return other.is_clear(trajectory); });
}

}  // namespace sidestep
