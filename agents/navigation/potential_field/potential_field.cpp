// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/potential_field/potential_field.hpp"

#include <algorithm>
#include <stdexcept>

namespace sidestep {
namespace {

/// K in the potential U = rho²/2 + K/2 (1/rho1 - 1/rho0)², where rho is the distance to the goal, rho1 that
/// to the nearest obstacle, and rho0 the reach of obstacles.
constexpr double kRepulsion = 0.01;
constexpr double kDescentStep_m = 0.01;  ///< step length of descend()
constexpr double kArrival_m = 0.02;      ///< distance from the goal that counts as arrived
/// Number of steps without progress after which a local minimum is reported.
constexpr std::size_t kPatience = 200;

}  // namespace

PotentialField::PotentialField(double robot_radius_m, const PotentialFieldSettings& settings)
    : robot_radius_m_(robot_radius_m), settings_(settings) {
  if (!(robot_radius_m >= 0) || !std::isfinite(robot_radius_m))
    throw std::invalid_argument("a potential field's robot radius must not be negative");
  if (!(settings.reach_m > 0) || !std::isfinite(settings.rotation))
    throw std::invalid_argument("the reach of a potential field has to be positive");
}

Vec2 PotentialField::force(const Vec2& at_m, const Vec2& goal_m, const FreeDistance& free) const {
  const Vec2 attractive = goal_m - at_m;
  const double gap = gap_m(free);
  if (gap >= settings_.reach_m || gap <= 0) return attractive;
  const double repulsive = kRepulsion * (1 / gap - 1 / settings_.reach_m) / (gap * gap);
  return attractive + repulsive * (free.away + settings_.rotation * left_of(free.away));
}

double PotentialField::potential(const Vec2& at_m, const Vec2& goal_m, const FreeDistance& free) const {
  const double gap = gap_m(free);
  if (gap <= 0) return std::numeric_limits<double>::infinity();
  const double nearness = std::max(0.0, 1 / gap - 1 / settings_.reach_m);
  return (goal_m - at_m).squaredNorm() / 2 + kRepulsion / 2 * nearness * nearness;
}

void PotentialField::begin(const Vec2& start_m) {
  if (!start_m.allFinite()) throw std::invalid_argument("the start of a descent has to be finite");
  descent_.end = DescentEnd::kStepsSpent;
  descent_.path_m.assign(1, start_m);
  is_touching_ = false;
}

bool PotentialField::makes_progress() const {
  const std::vector<Vec2>& path = descent_.path_m;
  if (path.size() <= kPatience) return true;
  // A robot in a minimum steps back and forth across it.
  constexpr double kProgress = 0.05;
  const double advanced_m = (path.back() - path[path.size() - 1 - kPatience]).norm();
  return advanced_m > kProgress * kDescentStep_m * kPatience;
}

bool PotentialField::check_end(const Vec2& goal_m, int max_steps) {
  const std::vector<Vec2>& path = descent_.path_m;
  if (is_touching_)
    descent_.end = DescentEnd::kTouching;
  else if ((goal_m - path.back()).norm() <= kArrival_m)
    descent_.end = DescentEnd::kArrived;
  else if (!makes_progress())
    descent_.end = DescentEnd::kLocalMinimum;
  else
    return path.size() > static_cast<std::size_t>(std::max(max_steps, 0));
  return true;
}

void PotentialField::step(const Vec2& goal_m, const FreeDistance& free) {
  if (gap_m(free) <= 0) {
    is_touching_ = true;
    return;
  }
  const Vec2 at = descent_.path_m.back(), pull = force(at, goal_m, free);
  const double length = pull.norm();
  // At most half the gap, so that the path cannot step over an obstacle.
  const double longest_m =
      std::min({kDescentStep_m, gap_m(free) / 2, std::max((goal_m - at).norm(), kArrival_m)});
  descent_.path_m.push_back(length > 0 ? Vec2(at + longest_m / length * pull) : at);
}

}  // namespace sidestep
