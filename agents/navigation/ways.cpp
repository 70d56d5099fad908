// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/ways.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// A way that has become longer by more than this is looked for anew.
constexpr double kLonger_m = 0.05;
// Enough for some hundred obstacles; a robot without a way goes straight on, as far as it is safe.
constexpr std::size_t kMostSamples = 5000;

std::vector<Shape> grown(const std::vector<Circle>& obstacles, double by_m) {
  std::vector<Shape> shapes;
  for (const Circle& circle : obstacles) shapes.push_back(Circle{circle.centre_m, circle.radius_m + by_m});
  return shapes;
}

}  // namespace

Ways::Ways(const std::vector<Circle>& obstacles, const Field& field, double radius_m, double margin_m,
           double extra_clearance_m, const Vec2& goal_m)
    : roomy_(grown(obstacles, margin_m + extra_clearance_m)),
      tight_(grown(obstacles, margin_m)),
      field_(field),
      radius_m_(radius_m),
      goal_m_(goal_m) {}

bool Ways::sees(const Vec2& from, const Vec2& to) const {
  return DiscDomain(*world_, field_, radius_m_, from, to).check(from, to);
}

bool Ways::find(const Vec2& start) {
  const DiscDomain domain(*world_, field_, radius_m_, start, goal_m_);
  Budget budget;
  budget.samples = kMostSamples;
  const Plan<Vec2>& plan = planner_.plan(domain, start, budget, rng_);
  next_ = 0;
  points_.clear();
  if (plan.arrives()) points_.assign(plan.states.begin() + 1, plan.states.end());
  return !points_.empty();
}

std::optional<Route> Ways::route_from(const Vec2& start) {
  if (const auto kept = kept_from(start)) return kept;
  world_ = &roomy_;
  if (!find(start)) {
    world_ = &tight_;
    if (!find(start)) return std::nullopt;
  }
  length_m_ = length_from(start);
  return Route{points_.front(), length_m_};
}

std::optional<Route> Ways::kept_from(const Vec2& start) {
  if (next_ >= points_.size()) return std::nullopt;
  while (next_ + 1 < points_.size() && sees(start, points_[next_ + 1])) ++next_;
  const double length = length_from(start);
  if (length > length_m_ + kLonger_m || !sees(start, points_[next_])) return std::nullopt;
  length_m_ = std::min(length_m_, length);
  return Route{points_[next_], length};
}

double Ways::length_from(const Vec2& start) const {
  double length = (points_[next_] - start).norm();
  for (std::size_t i = next_ + 1; i < points_.size(); ++i) length += (points_[i] - points_[i - 1]).norm();
  return length;
}

}  // namespace sidestep
