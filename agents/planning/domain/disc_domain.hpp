// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/geometry/field.hpp"

namespace sidestep {

struct DiscDomainSettings {
  double step_m = 2;  ///< maximum length of an extension
  /// Fraction of samples close to an obstacle. Short paths follow obstacles, and in narrow passages all
  /// positions are close to an obstacle.
  double contact_probability = 0.2;
};

/// The planning domain of a disc that moves in straight lines on a field with obstacles. All checks are exact
/// and cover the whole motion. Keeps a reference to the world, which must outlive it. A domain is made for a
/// single query; construction is cheap if start and goal are free.
///
/// A start that touches obstacles, or lies outside the field, may be left by motions that come no nearer to
/// any obstacle it touches. Since shapes are convex, such a motion does not re-enter them. A goal that
/// touches an obstacle is replaced by the nearest free position.
class DiscDomain {
 public:
  using State = Vec2;
  static constexpr std::size_t kDimensions = 2;

  DiscDomain(const ObstacleWorld& world, const Field& field, double radius_m, const Vec2& start_m,
             const Vec2& goal_m, const DiscDomainSettings& settings = {});
  /// Selects a domain without a goal: its goal is the start, and is not replaced if it is blocked.
  struct WithoutGoal {};
  DiscDomain(WithoutGoal, const ObstacleWorld& world, const Field& field, double radius_m,
             const Vec2& start_m, const DiscDomainSettings& settings = {});

  double distance(const Vec2& a, const Vec2& b) const {
    const double x = a.x() - b.x(), y = a.y() - b.y();
    return std::sqrt(x * x + y * y);
  }
  std::optional<Vec2> extend(const Vec2& from, const Vec2& to) const;
  bool check(const Vec2& from, const Vec2& to) const {
    if (field_.contains(from, radius_m_) && field_.contains(to, radius_m_) &&
        !world_->touches(from, to, radius_m_))
      return true;
    return start_is_blocked_ && is_escape(from, to);
  }
  Vec2 sample(Rng& rng) const;
  Vec2 goal(const Vec2&) const { return goal_m_; }
  std::array<double, 2> coordinates(const Vec2& state) const { return {state.x(), state.y()}; }
  Vec2 between(const Vec2& a, const Vec2& b, double fraction) const { return a + fraction * (b - a); }

  bool start_is_blocked() const { return start_is_blocked_; }
  bool goal_is_blocked() const { return goal_is_blocked_; }
  /// The nearest free position that a blocked start can reach in a straight line without coming nearer to any
  /// obstacle that it touches; nullopt if there is none.
  std::optional<Vec2> exit() const;
  /// Free positions near a blocked goal, sorted by distance.
  std::vector<Vec2> free_positions_near_goal() const;
  /// A copy that uses another free position as the replacement of a blocked goal.
  DiscDomain with_goal_at(const Vec2& position_m) const;

  const ObstacleWorld& world() const { return *world_; }
  const Field& field() const { return field_; }
  double radius_m() const { return radius_m_; }

 private:
  bool is_free(const Vec2& position) const {
    return field_.contains(position, radius_m_) && !world_->touches(position, radius_m_);
  }
  /// Whether a motion, forwards or backwards, escapes from the blocked start.
  bool is_escape(const Vec2& from, const Vec2& to) const;
  bool escapes(const Vec2& from, const Vec2& to) const;
  /// The nearest position outside the deepest obstacle, if that position is free.
  std::optional<Vec2> projected_out(const Vec2& position) const;
  void measure_from_start();
  /// The nearest free position that `can_reach` accepts; nullopt: there is none. See nearest_free_position().
  std::optional<Vec2> free_position_near(const Vec2& position,
                                         const std::function<bool(const Vec2&)>& can_reach = {}) const;
  Vec2 sample_uniform(Rng& rng) const;
  Vec2 sample_contact(Rng& rng) const;

  const ObstacleWorld* world_;
  Field field_;
  double radius_m_;
  Vec2 start_m_, requested_goal_m_, goal_m_;  // goal_m_ replaces a blocked requested goal
  bool start_is_blocked_, goal_is_blocked_;
  DiscDomainSettings settings_;
  std::vector<double> start_distances_m_;  // distance of a blocked start from each obstacle of the world
};

static_assert(EuclideanDomain<DiscDomain> && StraightDomain<DiscDomain>);

}  // namespace sidestep
