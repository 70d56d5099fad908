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

SafetySearch::SafetySearch(const FloorRules& rules, const SearchSettings& settings)
    : rules_(rules), settings_(settings) {
  samples_.reserve(static_cast<std::size_t>(settings.samples) + 1);
  near_.reserve(64);
}

SearchResult SafetySearch::search(const SearchQuery& query, std::span<const Version> others, Rng& rng) {
  draw_samples(query, rng);
  find_near(query, others);
  SearchResult result;
  std::array<Vec2, SearchResult::kMaxCandidates> chosen;
  for (const Sample& sample : samples_) {
    const auto close_to_sample = [&](const Vec2& a) {
      return (a - sample.acceleration_mps2).squaredNorm() < settings_.spread_mps2 * settings_.spread_mps2;
    };
    if (std::any_of(chosen.begin(), chosen.begin() + result.count, close_to_sample)) continue;
    const Trajectory trajectory = accelerate_then_stop(query.start, query.at_start, sample.acceleration_mps2,
                                                       query.phase, rules_.limits.deceleration_mps2);
    if (!rests_before_all(trajectory, query.moving, rules_.radius_m + rules_.margin_m)) continue;
    if (!is_allowed(trajectory, result.checks)) continue;
    result.wish_is_clear = result.wish_is_clear || sample.distance2 == 0;
    chosen[result.count] = sample.acceleration_mps2;
    result.candidates[result.count++] = trajectory;
    if (result.count == SearchResult::kMaxCandidates) break;
  }
  return result;
}

void SafetySearch::draw_samples(const SearchQuery& query, Rng& rng) {
  const Vec2& velocity = query.at_start.velocity_mps;
  const Vec2 wish = limited(query.wish_mps2, velocity, rules_.limits, query.phase);
  samples_.clear();
  samples_.push_back({wish, 0});
  for (int i = 0; i < settings_.samples; ++i) {
    const Vec2 drawn = limited(sample(velocity, rules_.limits, rng), velocity, rules_.limits, query.phase);
    samples_.push_back({drawn, (drawn - wish).squaredNorm()});
  }
  std::sort(samples_.begin(), samples_.end(),
            [](const Sample& a, const Sample& b) { return a.distance2 < b.distance2; });
}

void SafetySearch::find_near(const SearchQuery& query, std::span<const Version> others) {
  const double seconds = to_seconds(query.phase);
  const double fastest = std::min(rules_.limits.speed_mps, query.at_start.velocity_mps.norm() +
                                                               rules_.limits.acceleration_mps2 * seconds);
  const double reach =
      fastest * seconds + fastest * fastest / (2 * rules_.limits.deceleration_mps2) + rules_.keep_m() + 1e-3;
  near_.clear();
  for (const Version& other : others) {
    const double far = reach + reach_m(other.trajectory);
    const Vec2 offset = other.trajectory.at_start().position_m - query.at_start.position_m;
    if (offset.squaredNorm() <= far * far) near_.push_back(&other);
  }
}

bool SafetySearch::is_allowed(const Trajectory& trajectory, int& checks) {
  if (check_place(trajectory, rules_) != msg::REASON_GRANTED) return false;
  const double keep = rules_.keep_m();
  for (std::size_t i = 0; i < near_.size(); ++i) {
    ++checks;
    if (is_clear(trajectory, near_[i]->trajectory, keep)) continue;
    // Whoever was in the way of this one will be in the way of the next: ask it first.
    std::swap(near_[i], near_.front());
    return false;
  }
  return true;
}

}  // namespace sidestep
