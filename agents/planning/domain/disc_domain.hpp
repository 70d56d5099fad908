// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/geometry/field.hpp"

namespace sidestep {

struct DiscDomainSettings {
  double step_m = 2;  ///< of an extension, at most
  /// How many of the states drawn lie close to an obstacle; ways lead along obstacles, and narrow passages
  /// are nothing but such places.
  double contact_probability = 0.2;
};

/// A disc that moves straight on a field among obstacles. All checks are exact, of the whole motion. It looks
/// at the world, which has to stay, and is made anew for each query, which costs next to nothing where start
/// and goal are free.
///
/// A start that touches obstacles, or is not in the field, may be left by motions that come no nearer to any
/// of what it touches; since shapes are convex, such a motion stays out of them for good once it is out. For
/// a goal that touches an obstacle the nearest free place stands in.
class DiscDomain {
 public:
  using State = Vec2;
  static constexpr std::size_t kDimensions = 2;

  DiscDomain(const ObstacleWorld& world, const Field& field, double radius_m, const Vec2& start_m,
             const Vec2& goal_m, const DiscDomainSettings& settings = {});

  double distance(const Vec2& a, const Vec2& b) const {
    const double x = a.x() - b.x(), y = a.y() - b.y();
    return std::sqrt(x * x + y * y);
  }
  std::optional<Vec2> extend(const Vec2& from, const Vec2& to) const;
  bool check(const Vec2& from, const Vec2& to) const {
    if (field_.contains(from, radius_m_) && field_.contains(to, radius_m_) &&
        !world_->touches(from, to, radius_m_))
      return true;
    return start_is_blocked_ && leaves(from, to);
  }
  Vec2 sample(Rng& rng) const;
  Vec2 goal(const Vec2&) const { return goal_m_; }
  std::array<double, 2> coordinates(const Vec2& state) const { return {state.x(), state.y()}; }
  Vec2 between(const Vec2& a, const Vec2& b, double part) const { return a + part * (b - a); }

  bool start_is_blocked() const { return start_is_blocked_; }
  bool goal_is_blocked() const { return goal_is_blocked_; }
  /// Near a blocked start, the free place that is reached first without coming nearer to what the start
  /// touches; none when there is no such place.
  std::optional<Vec2> exit() const;
  /// Free places near a goal that is blocked, the nearest first.
  std::vector<Vec2> places_near_goal() const;
  /// The same with another free place in place of a blocked goal.
  DiscDomain with_goal_at(const Vec2& place_m) const;

  const ObstacleWorld& world() const { return *world_; }
  const Field& field() const { return field_; }
  double radius_m() const { return radius_m_; }

 private:
  bool is_free(const Vec2& place) const {
    return field_.contains(place, radius_m_) && !world_->touches(place, radius_m_);
  }
  /// Whether a motion, forwards or backwards, leads out of the start.
  bool leaves(const Vec2& from, const Vec2& to) const;
  bool leads_out(const Vec2& from, const Vec2& to) const;
  /// The nearest free place, if that lies straight away from the obstacle that is touched most.
  std::optional<Vec2> pushed_out(const Vec2& place) const;
  Vec2 sample_anywhere(Rng& rng) const;
  Vec2 sample_contact(Rng& rng) const;

  const ObstacleWorld* world_;
  Field field_;
  double radius_m_;
  Vec2 start_m_, wanted_m_, goal_m_;  // the goal may stand in for a wanted one
  bool start_is_blocked_, goal_is_blocked_;
  DiscDomainSettings settings_;
};

static_assert(EuclideanDomain<DiscDomain> && StraightDomain<DiscDomain>);

}  // namespace sidestep
