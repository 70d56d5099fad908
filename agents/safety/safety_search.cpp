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
  return trajectory ? sidestep::is_clear(candidate, *trajectory, keep_m)
                    : sidestep::is_clear(candidate, centre_m, keep_m);
}

SafetySearch::SafetySearch(const FloorRules& rules, const SearchSettings& settings,
                           const batch::Kernels& kernels)
    : rules_(rules),
      settings_(settings),
      kernels_(&kernels),
      choice_(settings.samples, rules.limits, kernels) {
  for (const Circle& obstacle : rules.obstacles)
    obstacles_.push_back(outline_of(Trajectory::resting(Time{}, obstacle.centre_m)));
  constexpr std::size_t kUsuallyEnough = 64;
  found_.reserve(kUsuallyEnough);
  in_lanes_.reserve(kUsuallyEnough);
  near_.reserve(kUsuallyEnough);
  exact_.reserve(kUsuallyEnough);
}

SearchResult SafetySearch::search(const SearchQuery& query, Crowd& others, Rng& rng) {
  const MotionLimits& limits = rules_.limits;
  const Vec2 wish = limited(query.wish_mps2, query.at_start.velocity_mps, limits, query.phase);
  const Outline wished = outline_of(
      accelerate_then_stop(query.start, query.at_start, wish, query.phase, limits.deceleration_mps2));
  const double room = (wish.norm() + largest_acceleration_mps2(limits)) * reach_per_mps2(query, limits);

  SearchResult result;
  choice_.draw(query.at_start.velocity_mps, wish, query.phase, rng);
  find_near(query, {wished.disc.centre_m, wished.disc.radius_m + room}, others);
  compare(query, wished, room, result.checks);
  while (const auto index = choice_.take_nearest(settings_.spread_mps2)) {
    const Trajectory trajectory = accelerate_then_stop(
        query.start, query.at_start, choice_.acceleration(*index), query.phase, limits.deceleration_mps2);
    if (!is_allowed(trajectory, choice_.is_certainly_clear(*index))) continue;
    if (!rests_before_all(trajectory, query.moving, rules_.radius_m + rules_.margin_m)) continue;
    choice_.keep(*index);
    result.wish_is_clear = result.wish_is_clear || *index == 0;
    result.candidates[result.count++] = trajectory;
    if (result.count == SearchResult::kMaxCandidates) break;
  }
  return result;
}

void SafetySearch::find_near(const SearchQuery& query, const Circle& disc, Crowd& others) {
  lanes_.clear();
  in_lanes_.clear();
  exact_.clear();
  const double keep = rules_.keep_m() + query.grown_m;
  // Room for what clearances are computed to.
  constexpr double kRoom_m = 1e-6;
  found_.clear();
  others.find({disc.centre_m, disc.radius_m + keep + kRoom_m}, found_);
  for (const std::uint32_t index : found_) {
    const Version& version = others.versions()[index];
    consider(others.outline(index), {&version.trajectory, {}, keep + version.grown_m}, query.start);
  }
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const Circle& obstacle = rules_.obstacles[i];
    const double clearance = obstacle.radius_m + rules_.radius_m + rules_.margin_m + query.grown_m;
    const double far = disc.radius_m + clearance + kRoom_m;
    if ((obstacle.centre_m - disc.centre_m).squaredNorm() > far * far) continue;
    Outline outline = obstacles_[i];
    outline.start = query.start;
    consider(outline, {nullptr, obstacle.centre_m, clearance}, query.start);
  }
  const double room_x = rules_.field.length_m / 2 - rules_.radius_m - disc.radius_m;
  const double room_y = rules_.field.width_m / 2 - rules_.radius_m - disc.radius_m;
  is_near_border_ = !(std::abs(disc.centre_m.x()) < room_x && std::abs(disc.centre_m.y()) < room_y);
}

void SafetySearch::consider(const Outline& outline, const Other& other, Time start) {
  if (outline.is_plain && to_seconds(outline.start - start) + outline.seconds <= batch::kLongest_s) {
    lanes_.add(outline, other.keep_m, start);
    in_lanes_.push_back(other);
  } else {
    exact_.push_back(other);
  }
}

/// All candidates are about where the wish leads, so whoever is clear of that by the room that they take is
/// clear of all of them. Only with the others who are near each candidate is compared.
void SafetySearch::compare(const SearchQuery& query, const Outline& wish, double room_m, int& checks) {
  const double phase_s = to_seconds(query.phase);
  const double seconds = phase_s + longest_stop_s(query, rules_.limits);
  const bool is_plain = wish.is_plain && seconds <= batch::kLongest_s;
  if (!is_plain) exact_.insert(exact_.end(), in_lanes_.begin(), in_lanes_.end());
  near_ = exact_;
  if (!is_plain || lanes_.size() == 0) return;
  const double step_s = std::max(lanes_.seconds(), seconds) / batch::kSteps;
  const batch::Track track = choice_.sample_wish(query.at_start, phase_s, step_s);
  lanes_.sample(*kernels_, step_s);
  lanes_.compare(*kernels_, track, wish.acceleration_mps2, room_m);
  checks += static_cast<int>(lanes_.size());
  bool is_sampled = false;
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
    if (lanes_.is_clear(lane)) continue;
    if (!is_sampled) choice_.sample(query.at_start, phase_s, step_s);
    is_sampled = true;
    choice_.compare(lanes_.track(lane), lanes_.start_s(lane), lanes_.keep_m(lane),
                    lanes_.acceleration_mps2(lane));
    checks += static_cast<int>(choice_.size());
    near_.push_back(in_lanes_[lane]);
  }
}

bool SafetySearch::is_allowed(const Trajectory& trajectory, bool is_certainly_clear) const {
  if (is_near_border_ && !stays_on(rules_.field, rules_.radius_m, trajectory)) return false;
  const auto& in_question = is_certainly_clear ? exact_ : near_;
  return std::ranges::all_of(in_question, [&](const Other& other) { return other.is_clear(trajectory); });
}

}  // namespace sidestep
