// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/beam_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_set>
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
constexpr double kBeamSpare_s = 2, kMaxWay_s = 30;

/// The cell of the state space that contains a state; standstill is in the middle of a cell.
std::uint64_t state_cell(const State& state, double cell_m, double cell_mps) {
  const auto part = [](double x) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::lround(x)) & 0xffff);
  };
  const Vec2 at = state.position_m / cell_m, moving = state.velocity_mps / cell_mps;
  return part(at.x()) << 48 | part(at.y()) << 32 | part(moving.x()) << 16 | part(moving.y());
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
  for (int i = 0; i < kAccelerationDirections; ++i)
    request(strongest * rotated(forward, 2 * std::numbers::pi * i / kAccelerationDirections));
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

}  // namespace

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

double BeamPlanner::estimate_s(const State& state, double t_s) const {
  const double ahead_s =
      field_.time_to_goal_s(state.position_m + kLookAhead_s * state.velocity_mps, t_s + kLookAhead_s);
  if (ahead_s < TimeToGoalField::kNever_s) return t_s + kLookAhead_s + ahead_s;
  // The robot has to turn or brake.
  return t_s + 2 * kLookAhead_s + field_.time_to_goal_s(state.position_m, t_s);
}

void BeamPlanner::find_passing(const BeamQuery& query, const State& state, std::size_t step) {
  passing_.clear();
  const double fastest_mps = state.velocity_mps.norm() + query.limits.acceleration_mps2 * kBeamStep_s;
  const double reach_m = separation_m_ + fastest_mps * kBeamStep_s;
  const std::size_t sample = step * kSamplesPerStep;
  const auto add = [&](const Vec2& from_m, const Vec2& between_m, const Vec2& to_m) {
    if (squared_distance(state.position_m, {from_m, to_m}) <= reach_m * reach_m)
      passing_.push_back({{from_m, between_m, to_m}});
  };
  for (const SampledCourse* other : query.others)
    add(other->at(sample), other->at(sample + 1), other->at(sample + 2));
  if (sample < kWaitSamples)
    for (const Vec2& waiting_m : query.waiting_m) add(waiting_m, waiting_m, waiting_m);
}

void BeamPlanner::expand(const BeamQuery& query, std::uint32_t parent, std::size_t step, Rng& rng) {
  ++expanded_;
  const State from = nodes_[parent].state;
  find_passing(query, from, step);
  const double t_s = static_cast<double>(step + 1) * kBeamStep_s;
  for_each_acceleration(from, query.goal_m, query.limits, [&](const Vec2& acceleration) {
    const Vec2 between_m = state_after(from, acceleration, kCourseSample_s).position_m;
    State to = state_after(from, acceleration, kBeamStep_s);
    if (to.velocity_mps.norm() < kPlannedRest_mps) to.velocity_mps.setZero();
    if (t_s + (to.position_m - query.goal_m).norm() / query.limits.speed_mps >= best_s_) return;
    if (!is_clear(from.position_m, between_m) || !is_clear(between_m, to.position_m)) return;
    for (const Passing& other : passing_)
      if (!are_apart(from.position_m, between_m, other.at_m[0], other.at_m[1], separation_m_) ||
          !are_apart(between_m, to.position_m, other.at_m[1], other.at_m[2], separation_m_))
        return;
    const double arrival_s = estimate_s(to, t_s) + rng.uniform(0, kNoise_s);
    if (arrival_s < best_s_) candidates_.push_back({to, acceleration, parent, arrival_s});
  });
}

void BeamPlanner::keep_best_candidates() {
  std::vector<std::pair<double, std::uint32_t>> order;
  for (const Node& candidate : candidates_)
    order.emplace_back(candidate.estimate_s, static_cast<std::uint32_t>(order.size()));
  std::ranges::sort(order);
  std::unordered_set<std::uint64_t> cells, wide_cells;
  std::size_t kept = 0;
  for (const auto& [estimate_s, number] : order) {
    if (kept == settings_.width + settings_.varied) break;
    const Node& candidate = candidates_[number];
    const bool is_full = kept >= settings_.width;
    if (!is_full && !cells.insert(state_cell(candidate.state, kStateCell_m, kStateCell_mps)).second) continue;
    const bool is_other = wide_cells.insert(state_cell(candidate.state, kWideCell_m, kWideCell_mps)).second;
    if (is_full && !is_other) continue;
    nodes_.push_back(candidate);
    ++kept;
  }
  candidates_.clear();
}

bool BeamPlanner::is_free(const BeamQuery& query, const Trajectory& motion, std::size_t sample) const {
  const Time end = motion.end();
  Vec2 from_m = motion.at_start().position_m;
  Time at = motion.start();
  while (at < end) {
    at += from_seconds(kCourseSample_s);
    const Vec2 to_m = motion.state_at(at).position_m;
    if (!is_clear(from_m, to_m)) return false;
    for (const SampledCourse* other : query.others)
      if (!are_apart(from_m, to_m, other->at(sample), other->at(sample + 1), separation_m_)) return false;
    if (sample < kWaitSamples)
      for (const Vec2& waiting_m : query.waiting_m)
        if (!are_apart(from_m, to_m, waiting_m, waiting_m, separation_m_)) return false;
    from_m = to_m;
    ++sample;
  }
  // The robot stays at its goal.
  return std::ranges::all_of(query.others, [&](const SampledCourse* other) {
    bool is_apart = true;
    for (std::size_t k = sample; k < other->samples_m.size() && is_apart; ++k)
      is_apart = are_apart(query.goal_m, query.goal_m, other->at(k), other->at(k + 1), separation_m_);
    return is_apart && (other->samples_m.back() - query.goal_m).norm() >= separation_m_;
  });
}

void BeamPlanner::try_stop(const BeamQuery& query, std::uint32_t node, std::size_t step) {
  const State& from = nodes_[node].state;
  const Trajectory motion =
      fastest_stop(Time{} + static_cast<int>(step) * kBeamStep, from, query.goal_m, query.limits);
  const double arrival_s = to_seconds(motion.end() - Time{});
  if (arrival_s >= best_s_ || !is_free(query, motion, step * kSamplesPerStep)) return;
  best_s_ = arrival_s;
  best_stop_ = motion;
  best_node_ = node;
}

std::optional<SampledCourse> BeamPlanner::plan(const BeamQuery& query, Rng& rng) {
  best_s_ = query.latest_s;
  best_stop_.reset();
  nodes_.assign(1, Node{{query.start_m, {0, 0}}, {0, 0}, 0, 0});
  try_stop(query, 0, 0);
  if (best_stop_) return course_to(query, 0);  // No course is faster than the straight line.
  field_.compute(query.goal_m, query.limits.speed_mps, query.others);
  double end_s = 0;
  for (const SampledCourse* other : query.others) end_s = std::max(end_s, other->arrival_s());
  const double horizon_s =
      end_s + kBeamSpare_s + std::min(kMaxWay_s, field_.time_to_goal_s(query.start_m, end_s));
  std::size_t begin = 0;
  for (std::size_t step = 0; static_cast<double>(step) * kBeamStep_s < horizon_s; ++step) {
    const std::size_t end = nodes_.size();
    if (begin == end) break;
    for (std::size_t i = begin; i < std::min(end, begin + settings_.stops); ++i)
      try_stop(query, static_cast<std::uint32_t>(i), step);
    for (std::size_t i = begin; i < end; ++i)
      if (nodes_[i].estimate_s < best_s_) expand(query, static_cast<std::uint32_t>(i), step, rng);
    begin = end;
    keep_best_candidates();
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
  State state{query.start_m, {0, 0}};
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
