// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/disc_window.hpp"

#include <functional>
#include <stdexcept>
#include <tuple>

#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

/// Later collisions make no difference. Velocities that need this long to brake are inadmissible.
constexpr double kDiscHorizon_s = 0.7;

constexpr GridWindow kAllVelocities{{0, kGridSide - 1}, {0, kGridSide - 1}};

void check_query(const DiscWindowQuery& query) {
  if (!query.velocity_mps.allFinite() || !query.goal_m.allFinite())
    throw std::invalid_argument("a disc's velocity and goal have to be finite");
  if (!(query.cycle_s > 0) || !std::isfinite(query.cycle_s) || !(query.window_s.value_or(0) >= 0))
    throw std::invalid_argument("a disc's cycle has to be positive, and its window not negative");
}

std::vector<Vec2> velocities_of(const MotionLimits& limits) {
  for (const double limit : {limits.acceleration_mps2, limits.deceleration_mps2, limits.speed_mps}) {
    if (!(limit > 0) || !std::isfinite(limit))
      throw std::invalid_argument("the limits of a disc's motion have to be positive and finite");
  }
  std::vector<Vec2> velocities(kSlots, Vec2(0, 0));
  for_each_velocity(kAllVelocities, [&](int row, int column, std::size_t slot) {
    velocities[slot] = grid_velocity(row, column, limits.speed_mps);
  });
  return velocities;
}

}  // namespace

DiscWindow::DiscWindow(double radius_m, const MotionLimits& limits, const DiscWindowSettings& settings)
    : limits_(limits),
      settings_(settings),
      times_({radius_m, velocities_of(limits)}, settings.method, static_cast<float>(kDiscHorizon_s),
             [&] { return disc_cell_times(radius_m, limits.speed_mps, settings.cell_m, kDiscHorizon_s); }) {
  if (!(radius_m > 0) || !std::isfinite(radius_m))
    throw std::invalid_argument("a disc's radius has to be positive and finite");
  check(settings.weights);
  choice_.admissible.reserve(kSlots);
  reachable_.reserve(kSlots);
}

void DiscWindow::prepare(double cycle_s) {
  if (cycle_s == cycle_s_) return;
  cycle_s_ = cycle_s;
  needed_s_.fill(kForbidden_s);
  for_each_velocity(kAllVelocities, [&](int, int, std::size_t slot) {
    const Vec2& velocity = times_.outline().velocities_mps[slot];
    if (!is_within_speed(velocity, limits_.speed_mps)) return;
    const double brake_s = velocity.norm() / limits_.deceleration_mps2;
    // Rounded up, which makes comparisons in single precision conservative.
    needed_s_[slot] = std::nextafter(static_cast<float>(brake_s + cycle_s), kForbidden_s);
  });
}

GridWindow DiscWindow::window_around(const Vec2& velocity_mps, double window_s) const {
  const double change_mps = std::max(limits_.acceleration_mps2, limits_.deceleration_mps2) * window_s;
  return {reachable_indices(velocity_mps.x(), change_mps, limits_.speed_mps),
          reachable_indices(velocity_mps.y(), change_mps, limits_.speed_mps)};
}

bool DiscWindow::is_reachable(std::size_t slot, const Vec2& velocity_mps, double window_s) const {
  const Vec2 change_mps = times_.outline().velocities_mps[slot] - velocity_mps;
  return change_mps.isZero(0) ||
         (window_s > 0 && is_admissible(change_mps / window_s, velocity_mps, limits_));
}

void DiscWindow::find_reachable(const GridWindow& window, const Vec2& velocity_mps, double window_s) {
  reachable_.clear();
  for_each_velocity(window, [&](int, int, std::size_t slot) {
    if (needed_s_[slot] < kForbidden_s && is_reachable(slot, velocity_mps, window_s))
      reachable_.push_back(slot);
  });
  if (!reachable_.empty()) return;
  for_each_velocity(window, [&](int, int, std::size_t slot) { reachable_.push_back(slot); });
}

Objectives DiscWindow::rate(std::size_t slot, const Vec2& goal_m) const {
  const Vec2& velocity = times_.outline().velocities_mps[slot];
  const double speed = velocity.norm();
  const Vec2 to_go = goal_m - velocity * (cycle_s_ + speed / limits_.deceleration_mps2 / 2);
  const double stopping_mps = std::sqrt(2 * limits_.deceleration_mps2 * goal_m.norm());
  const double off_mps = speed - std::min(stopping_mps, limits_.speed_mps);
  return {distance_objective(times_.time_s(slot), needed_s_[slot], static_cast<float>(kDiscHorizon_s)),
          speed == 0 ? 0.5F  // at rest there is no direction
                     : heading_objective(static_cast<float>(velocity.dot(to_go)),
                                         static_cast<float>(cross(velocity, to_go))),
          static_cast<float>(1 - std::abs(off_mps) / limits_.speed_mps)};
}

const DiscWindowChoice& DiscWindow::choose(const DiscWindowQuery& query) {
  check_query(query);
  prepare(query.cycle_s);
  choice_.admissible.clear();
  const double window_s = query.window_s.value_or(query.cycle_s);
  const Vec2& now = query.velocity_mps;
  const GridWindow window = window_around(now, window_s);
  choice_.is_touching = !times_.compute(query.points_m, window, needed_s_);
  if (choice_.is_touching) return choice_;
  find_reachable(window, now, window_s);
  for (const std::size_t slot : reachable_) {
    if (times_.time_s(slot) <= needed_s_[slot]) continue;
    const Objectives objectives = rate(slot, query.goal_m);
    choice_.admissible.push_back({times_.outline().velocities_mps[slot], times_.time_s(slot), objectives,
                                  objectives.weighted(settings_.weights)});
  }
  // Ties are broken by the velocity: the order must not depend on the library.
  std::ranges::sort(choice_.admissible, std::greater<>(), [](const RatedVelocity& rated) {
    return std::tuple(rated.value, rated.velocity_mps.x(), rated.velocity_mps.y());
  });
  return choice_;
}

}  // namespace sidestep
