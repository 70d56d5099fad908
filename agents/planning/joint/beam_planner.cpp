// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/beam_planner.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "agents/planning/joint/fastest_stop.hpp"
#include "common/geometry/segment.hpp"
#include "common/motion/rest.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kSamplesPerStep = 2;
constexpr double kBeamStep_s = kSamplesPerStep * kCourseSample_s;
constexpr Duration kBeamStep{100'000'000};
constexpr int kAccelerationDirections = 12;
/// The estimate looks at the place where the robot will be after this time if it keeps its velocity.
constexpr double kLookAhead_s = 0.3;
/// States whose positions and velocities fall into the same cell are too similar to keep both.
constexpr double kStateCell_m = 0.04, kStateCell_mps = 0.3;
/// Cells for variety: in each of them, one state is kept even if all others are better.
constexpr double kWideCell_m = 0.25, kWideCell_mps = 1.5;
/// A random part of estimates, so that repeated searches find different courses.
constexpr double kNoise_s = 0.01;
/// A robot without a course is assumed to wait this long at its start: it cannot be out of the way earlier.
constexpr double kWait_s = 0.35;
constexpr std::size_t kWaitSamples = static_cast<std::size_t>(kWait_s / kCourseSample_s);
/// Searches end this long after all other robots rest, plus the time to the goal.
constexpr double kBeamSpare_s = 2;
constexpr double kMaxWay_s = 30;  ///< if the goal is not reached by then, it never is
/// A robot that starts too close to another one may stay as close for this many samples, less a tolerance.
constexpr std::size_t kNearSamples = 12;
constexpr double kNearTolerance_m = 0.004;
/// Number of times at which the distance of two braking robots is compared. Between them it cannot become
/// much smaller, because both slow down steadily.
constexpr int kBrakingSamples = 4;

constexpr std::size_t kSlotsPerCell = 4;
constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15;  ///< spreads neighbouring cells (Fibonacci hashing)

/// The cell of the state space that contains a state; standstill is in the middle of a cell.
std::uint64_t state_cell(const State& state, double cell_m, double cell_mps) {
  // Adding half a period keeps the value positive, so that it is rounded down.
  const auto part = [](double x) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(x + (0x8000 + 0.5)) & 0xffff);
  };
  const Vec2 at = state.position_m / cell_m, moving = state.velocity_mps / cell_mps;
  return part(at.x()) << 48 | part(at.y()) << 32 | part(moving.x()) << 16 | part(moving.y());
}

std::uint64_t wide_state_cell(const State& state) { return state_cell(state, kWideCell_m, kWideCell_mps); }

/// Unit vectors in all directions from that of the x axis on.
const std::array<Vec2, kAccelerationDirections>& directions() {
  static const auto all = [] {
    std::array<Vec2, kAccelerationDirections> unit;
    for (int i = 0; i < kAccelerationDirections; ++i)
      unit[static_cast<std::size_t>(i)] =
          rotated(Vec2(1, 0), 2 * std::numbers::pi * i / kAccelerationDirections);
    return unit;
  }();
  return all;
}

/// Calls `call` with the accelerations that a robot may choose: full effort in all directions, gentle
/// braking, none, towards its goal at full speed, and towards rest.
template <typename Call>
void for_each_acceleration(const State& state, const Vec2& goal_m, const MotionLimits& limits, Call call) {
  const Vec2 way = goal_m - state.position_m;
  const Vec2 ahead = way.norm() > 0 ? Vec2(way.normalized()) : Vec2(1, 0);
  const bool is_moving = state.velocity_mps.norm() >= kPlannedRest_mps;
  const Vec2 forward = is_moving ? forward_of(state.velocity_mps) : ahead;
  const double strongest = std::max(limits.acceleration_mps2, limits.deceleration_mps2);
  const auto request = [&](const Vec2& acceleration) {
    call(limit_acceleration(acceleration, state.velocity_mps, limits, kBeamStep));
  };
  for (const Vec2& direction : directions())
    request(strongest * (direction.x() * forward + direction.y() * left_of(forward)));
  request(Vec2::Zero());
  request((limits.speed_mps * ahead - state.velocity_mps) / kBeamStep_s);
  if (!is_moving) return;
  request(-state.velocity_mps / kBeamStep_s);
  request(-limits.deceleration_mps2 / 2 * forward);
}

bool are_apart(const Vec2& from_m, const Vec2& to_m, const Vec2& other_from_m, const Vec2& other_to_m,
               double separation_m) {
  return squared_distance(Vec2(0, 0), Segment{from_m - other_from_m, to_m - other_to_m}) >=
         separation_m * separation_m;
}

/// Where a robot is after braking for a time.
Vec2 position_braking(const State& from, double speed_mps, double deceleration_mps2, double t_s) {
  const double until_s = std::min(t_s, speed_mps / deceleration_mps2);
  if (speed_mps < kPlannedRest_mps) return from.position_m;
  return from.position_m +
         from.velocity_mps * (until_s - deceleration_mps2 * until_s * until_s / (2 * speed_mps));
}

/// The rectangle of a start and a goal, enlarged, within the field.
Box area_of(const BeamQuery& query, const Field& field, double detour_m) {
  const Vec2 detour(detour_m, detour_m), corner_m(field.length_m / 2, field.width_m / 2);
  return {(query.start_m.cwiseMin(query.goal_m) - detour).cwiseMax(-corner_m),
          (query.start_m.cwiseMax(query.goal_m) + detour).cwiseMin(corner_m)};
}

}  // namespace

void CellSet::clear(std::size_t count) { slots_.assign(std::bit_ceil(kSlotsPerCell * (count + 1)), kEmpty); }

std::size_t CellSet::slot_of(std::uint64_t cell) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = (cell * kGolden) >> 32 & mask;
  while (slots_[slot] != cell && slots_[slot] != kEmpty) slot = (slot + 1) & mask;
  return slot;
}

BeamPlanner::BeamPlanner(const JointProblem& problem, const BeamSettings& settings)
    : problem_(&problem), settings_(settings), field_(problem) {
  const double error_m =
      sampling_error_m(std::max(problem.limits.acceleration_mps2, problem.limits.deceleration_mps2));
  separation_m_ = problem.min_separation_m() + 2 * error_m;
  from_obstacles_m_ = problem.distance_from_obstacles_m() + error_m;
}

bool BeamPlanner::can_rest_at(std::span<const Vec2> positions_m) const {
  for (std::size_t i = 0; i < positions_m.size(); ++i) {
    if (!is_clear(positions_m[i], positions_m[i])) return false;
    for (std::size_t j = 0; j < i; ++j)
      if ((positions_m[i] - positions_m[j]).norm() < separation_m_) return false;
  }
  return true;
}

bool BeamPlanner::is_clear(const Vec2& from_m, const Vec2& to_m) const {
  return problem_->field.contains(to_m, from_obstacles_m_) &&
         !problem_->world->touches(from_m, to_m, from_obstacles_m_);
}

double BeamPlanner::estimate_s(const State& state, double t_s, const Moments& moments) const {
  const double ahead_s =
      field_.time_to_goal_s(state.position_m + kLookAhead_s * state.velocity_mps, moments.ahead);
  if (ahead_s < TimeToGoalField::kNever_s) return t_s + kLookAhead_s + ahead_s;
  // The robot has to turn or brake.
  return t_s + 2 * kLookAhead_s + field_.time_to_goal_s(state.position_m, moments.present);
}

double BeamPlanner::separation_m(double at_start_m, std::size_t sample) const {
  return sample < kNearSamples ? std::min(separation_m_, at_start_m - kNearTolerance_m) : separation_m_;
}

void BeamPlanner::set_separations(const BeamQuery& query) {
  at_start_m_.clear();
  for (const TimedPositions& other : query.others)
    at_start_m_.push_back((other.at_m.front() - query.start_m).norm());
  waiting_at_start_m_.clear();
  for (const Vec2& waiting_m : query.waiting_m)
    waiting_at_start_m_.push_back((waiting_m - query.start_m).norm());
  max_deceleration_mps2_ = query.limits.deceleration_mps2;
  goal_free_from_ = 0;
  for (const TimedPositions& other : query.others) {
    if (other.stays && (other.at_m.back() - query.goal_m).norm() < separation_m_)
      goal_free_from_ = kNeverFree;
    for (std::size_t k = other.at_m.size(); k-- > goal_free_from_;)
      if (!are_apart(query.goal_m, query.goal_m, other.at(k), other.at(k + 1), separation_m_))
        goal_free_from_ = k + 1;
  }
}

BeamPlanner::PassingRange BeamPlanner::find_passing(const BeamQuery& query, const State& state,
                                                    std::size_t step) {
  PassingRange range{static_cast<std::uint32_t>(passing_.size()), 0};
  const double speed_mps = state.velocity_mps.norm() + query.limits.acceleration_mps2 * kBeamStep_s;
  const double fastest_mps = std::max(speed_mps, query.limits.speed_mps);
  const double braking_m =
      settings_.braking_separation_m > 0 ? fastest_mps * fastest_mps / max_deceleration_mps2_ : 0;
  const double reach_m = separation_m_ + speed_mps * kBeamStep_s + braking_m;
  const std::size_t sample = step * kSamplesPerStep;
  const auto add = [&](const Vec2& from_m, const Vec2& between_m, const Vec2& to_m, double at_start_m) {
    if (squared_distance(state.position_m, {from_m, to_m}) <= reach_m * reach_m)
      passing_.push_back({{from_m, between_m, to_m},
                          separation_m(at_start_m, sample),
                          (to_m - between_m) / kCourseSample_s});
  };
  for (std::size_t i = 0; i < query.others.size(); ++i) {
    const TimedPositions& other = query.others[i];
    if (other.is_known(sample))
      add(other.at(sample), other.at(sample + 1), other.at(sample + 2), at_start_m_[i]);
  }
  if (sample < kWaitSamples)
    for (std::size_t i = 0; i < query.waiting_m.size(); ++i)
      add(query.waiting_m[i], query.waiting_m[i], query.waiting_m[i], waiting_at_start_m_[i]);
  range.end = static_cast<std::uint32_t>(passing_.size());
  return range;
}

void BeamPlanner::expand(const BeamQuery& query, std::uint32_t parent, std::size_t step, Rng& rng) {
  ++expanded_;
  const State from = nodes_[parent].state;
  const double t_s = static_cast<double>(step + 1) * kBeamStep_s;
  const Moments moments{field_.at_time(t_s), field_.at_time(t_s + kLookAhead_s)};
  for_each_acceleration(from, query.goal_m, query.limits, [&](const Vec2& acceleration) {
    State to = state_after(from, acceleration, kBeamStep_s);
    if (to.velocity_mps.norm() < kPlannedRest_mps) to.velocity_mps.setZero();
    if (t_s + (to.position_m - query.goal_m).norm() / query.limits.speed_mps >= best_s_) return;
    const double arrival_s = estimate_s(to, t_s, moments) + rng.uniform(0, kNoise_s);
    if (arrival_s < best_s_) candidates_.push_back({to, acceleration, parent, arrival_s});
  });
}

bool BeamPlanner::is_possible(const Node& candidate, const PassingRange& passing) const {
  const State& from = nodes_[candidate.parent].state;
  const Vec2 between_m = state_after(from, candidate.acceleration_mps2, kCourseSample_s).position_m;
  const Vec2& to_m = candidate.state.position_m;
  for (std::uint32_t i = passing.begin; i < passing.end; ++i) {
    const Passing& other = passing_[i];
    if (!are_apart(from.position_m, between_m, other.at_m[0], other.at_m[1], other.separation_m) ||
        !are_apart(between_m, to_m, other.at_m[1], other.at_m[2], other.separation_m))
      return false;
  }
  return is_clear(from.position_m, between_m) && is_clear(between_m, to_m) &&
         (settings_.braking_separation_m <= 0 || can_brake(candidate.state, passing));
}

bool BeamPlanner::can_brake(const State& state, const PassingRange& passing) const {
  const double own_mps = state.velocity_mps.norm();
  for (std::uint32_t i = passing.begin; i < passing.end; ++i) {
    const State other{passing_[i].at_m[2], passing_[i].velocity_mps};
    const double other_mps = other.velocity_mps.norm();
    const double separation_m = std::min(passing_[i].separation_m, settings_.braking_separation_m);
    const double stop_s = std::max(own_mps, other_mps) / max_deceleration_mps2_;
    for (int k = 1; k <= kBrakingSamples; ++k) {
      const double t_s = stop_s * k / kBrakingSamples;
      const Vec2 between_m = position_braking(state, own_mps, max_deceleration_mps2_, t_s) -
                             position_braking(other, other_mps, max_deceleration_mps2_, t_s);
      if (between_m.squaredNorm() < separation_m * separation_m) return false;
    }
  }
  return true;
}

void BeamPlanner::keep_best_candidates(const BeamQuery& query, std::size_t begin, std::size_t step) {
  order_.clear();
  for (const Node& candidate : candidates_)
    order_.emplace_back(candidate.estimate_s, static_cast<std::uint32_t>(order_.size()));
  std::ranges::make_heap(order_, std::greater<>());
  cells_.clear(settings_.width);
  wide_cells_.clear(settings_.width + settings_.varied);
  passing_.clear();
  passing_of_.assign(nodes_.size() - begin, std::nullopt);
  std::size_t kept = 0;
  while (!order_.empty() && kept < settings_.width + settings_.varied) {
    std::ranges::pop_heap(order_, std::greater<>());
    const Node& candidate = candidates_[order_.back().second];
    order_.pop_back();
    const bool is_full = kept >= settings_.width;
    const std::uint64_t wide_cell = wide_state_cell(candidate.state);
    const std::uint64_t cell = state_cell(candidate.state, kStateCell_m, kStateCell_mps);
    if (is_full ? wide_cells_.contains(wide_cell) : cells_.contains(cell)) continue;
    // Most candidates are never looked at, so the expensive checks come last.
    std::optional<PassingRange>& passing = passing_of_[candidate.parent - begin];
    if (!passing) passing = find_passing(query, nodes_[candidate.parent].state, step);
    if (!is_possible(candidate, *passing)) continue;
    if (!is_full) cells_.insert(cell);
    wide_cells_.insert(wide_cell);
    nodes_.push_back(candidate);
    if (++kept == settings_.width) drop_taken();
  }
  candidates_.clear();
}

void BeamPlanner::drop_taken() {
  std::erase_if(order_, [&](const auto& entry) {
    return wide_cells_.contains(wide_state_cell(candidates_[entry.second].state));
  });
  std::ranges::make_heap(order_, std::greater<>());
}

bool BeamPlanner::is_free(const BeamQuery& query, const Trajectory& motion, std::size_t sample) const {
  const Time end = motion.end();
  Vec2 from_m = motion.at_start().position_m;
  Time at = motion.start();
  while (at < end) {
    at += from_seconds(kCourseSample_s);
    const Vec2 to_m = motion.state_at(at).position_m;
    if (!is_clear(from_m, to_m)) return false;
    for (std::size_t i = 0; i < query.others.size(); ++i) {
      const TimedPositions& other = query.others[i];
      if (other.is_known(sample) && !are_apart(from_m, to_m, other.at(sample), other.at(sample + 1),
                                               separation_m(at_start_m_[i], sample)))
        return false;
    }
    for (std::size_t i = 0; i < query.waiting_m.size() && sample < kWaitSamples; ++i)
      if (!are_apart(from_m, to_m, query.waiting_m[i], query.waiting_m[i],
                     separation_m(waiting_at_start_m_[i], sample)))
        return false;
    from_m = to_m;
    ++sample;
  }
  // The robot stays at its goal.
  return sample >= goal_free_from_ && is_clear(query.goal_m, query.goal_m);
}

void BeamPlanner::try_stop(const BeamQuery& query, std::uint32_t node, std::size_t step) {
  const State& from = nodes_[node].state;
  const auto latest =
      static_cast<std::size_t>(longest_stop_s(from, query.goal_m, query.limits) / kCourseSample_s);
  if (step * kSamplesPerStep + latest + 2 < goal_free_from_) return;
  const Trajectory motion =
      fastest_stop(Time{} + static_cast<int>(step) * kBeamStep, from, query.goal_m, query.limits);
  const double arrival_s = to_seconds(motion.end() - Time{});
  if (arrival_s >= best_s_ || !is_free(query, motion, step * kSamplesPerStep)) return;
  best_s_ = arrival_s;
  best_stop_ = motion;
  best_node_ = node;
}

std::optional<SampledCourse> BeamPlanner::plan_straight(const BeamQuery& query) {
  best_s_ = query.latest_s;
  best_stop_.reset();
  nodes_.assign(1, Node{{query.start_m, query.start_mps}, {0, 0}, 0, 0});
  set_separations(query);
  try_stop(query, 0, 0);
  if (!best_stop_) return std::nullopt;
  return course_to(query, 0);
}

std::optional<SampledCourse> BeamPlanner::plan(const BeamQuery& query, std::span<const BeamSettings> attempts,
                                               Rng& rng) {
  // No course is faster than the straight line.
  if (std::optional<SampledCourse> straight = plan_straight(query)) return straight;
  if (!problem_->field.contains(query.start_m, 0) || !is_clear(query.goal_m, query.goal_m))
    return std::nullopt;
  if (kCourseSample_s * (static_cast<double>(goal_free_from_) - 1) >= query.latest_s) return std::nullopt;
  field_.compute(area_of(query, problem_->field, attempts.front().detour_m), query.goal_m,
                 query.limits.speed_mps, query.others);
  for (const BeamSettings& attempt : attempts) {
    settings_ = attempt;
    if (std::optional<SampledCourse> found = search(query, rng)) return found;
  }
  return std::nullopt;
}

std::optional<SampledCourse> BeamPlanner::search(const BeamQuery& query, Rng& rng) {
  nodes_.resize(1);
  double last_s = 0;
  for (const TimedPositions& other : query.others) last_s = std::max(last_s, other.end_s());
  const double way_s = std::min(kMaxWay_s, field_.time_to_goal_s(query.start_m, last_s));
  const double horizon_s = std::min(query.latest_s, last_s + kBeamSpare_s + way_s);
  const std::size_t expanded_before = expanded_;
  std::size_t begin = 0;
  for (std::size_t step = 0; static_cast<double>(step) * kBeamStep_s < horizon_s; ++step) {
    const std::size_t end = nodes_.size();
    if (begin == end || expanded_ - expanded_before >= query.max_expanded) break;
    for (std::size_t i = begin; i < std::min(end, begin + settings_.stops); ++i)
      try_stop(query, static_cast<std::uint32_t>(i), step);
    for (std::size_t i = begin; i < end; ++i)
      if (nodes_[i].estimate_s < best_s_) expand(query, static_cast<std::uint32_t>(i), step, rng);
    const std::size_t first = std::exchange(begin, end);
    keep_best_candidates(query, first, step);
  }
  if (!best_stop_) return std::nullopt;
  return course_to(query, best_node_);
}

SampledCourse BeamPlanner::course_to(const BeamQuery& query, std::uint32_t node) const {
  std::vector<std::uint32_t> path;
  for (; node != 0; node = nodes_[node].parent) path.push_back(node);
  std::ranges::reverse(path);
  SampledCourse result{Course(Time{}, query.start_m), {query.start_m}};
  Time at{};
  State state{query.start_m, query.start_mps};
  for (std::size_t i = 0; i < path.size(); i += Trajectory::kMaxPhases) {
    Trajectory leg(at, state);
    for (std::size_t j = i; j < std::min(path.size(), i + Trajectory::kMaxPhases); ++j) {
      const Node& to = nodes_[path[j]];
      leg.append(kBeamStep, to.acceleration_mps2);
      result.samples_m.push_back(state_after(state, to.acceleration_mps2, kCourseSample_s).position_m);
      result.samples_m.push_back(to.state.position_m);
      state = to.state;
      at += kBeamStep;
    }
    result.course.append(leg);
  }
  result.course.append(*best_stop_);
  while (at < best_stop_->end()) {
    at += from_seconds(kCourseSample_s);
    result.samples_m.push_back(best_stop_->state_at(at).position_m);
  }
  return result;
}

}  // namespace sidestep
