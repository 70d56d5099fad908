// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <variant>

#include "common/collision/box_tree.hpp"
#include "common/collision/extent_masks.hpp"
#include "common/collision/linear_set.hpp"
#include "common/collision/obstacle_id.hpp"

namespace sidestep {

/// How a world finds the obstacles that a query may touch.
enum class Structure {
  kAutomatic,  ///< by the number of obstacles
  kLinear,     ///< see LinearSet
  kMasks,      ///< see ExtentMasks
  kTree,       ///< see BoxTree
};

/// The obstacle nearest to a point: infinitely far, and none, in an empty world.
struct Nearest {
  double distance_m = std::numeric_limits<double>::infinity();  ///< to its border, negative inside
  ObstacleId obstacle = kNoObstacle;
};

/// Where a disc on its way touches for the first time.
struct Contact {
  double part = 0;  ///< of the way that is free, 0 to 1
  ObstacleId obstacle = kNoObstacle;
};

/// Obstacles and what touches them; touching is having a point in common. Obstacles come, move and go without
/// the rest being built anew. Const functions may be called by many threads at a time and do not allocate.
/// Whatever is not finite, a negative radius, a wrong shape (see check) and an id that is not in use are
/// refused with std::invalid_argument.
class ObstacleWorld {
 public:
  explicit ObstacleWorld(std::vector<Shape> shapes = {}, Structure structure = Structure::kAutomatic);
  /// With the inner loops of an instruction set that is not the best, for comparisons.
  ObstacleWorld(std::vector<Shape> shapes, Structure structure, const collision::Kernels& kernels);

  ObstacleWorld(const ObstacleWorld& other) : ObstacleWorld(Parts(other.parts_)) {}
  ObstacleWorld& operator=(const ObstacleWorld& other);

  /// Whether a disc at a place touches an obstacle.
  bool touches(const Vec2& at_m, double radius_m) const { return touches(at_m, at_m, radius_m); }
  /// Whether a disc touches an obstacle anywhere on its straight way.
  bool touches(const Vec2& from_m, const Vec2& to_m, double radius_m) const {
    const collision::Answer answer = sweep_(view_, from_m.data(), to_m.data(), radius_m);
    if (answer == collision::Answer::kInDoubt) [[unlikely]]
      return touches_exactly(from_m, to_m, radius_m);
    return answer == collision::Answer::kTouches;
  }
  /// How far the disc can go; none if it can go all the way, but for ways that touch no more than rounding.
  std::optional<Contact> first_contact(const Vec2& from_m, const Vec2& to_m, double radius_m) const;
  Nearest nearest(const Vec2& at_m) const;

  /// The shapes given to the constructor have the ids 0, 1, 2, … in their order.
  ObstacleId add(Shape shape);
  void move(ObstacleId obstacle, const Vec2& by_m);
  void remove(ObstacleId obstacle);

  std::size_t size() const { return parts_.bodies.slots().size(); }
  bool has(ObstacleId obstacle) const { return parts_.bodies.has(static_cast<Slot>(obstacle)); }
  const Shape& shape(ObstacleId obstacle) const;
  /// One of the size() obstacles, in no order.
  ObstacleId obstacle(std::size_t i) const { return ObstacleId{parts_.bodies.slots()[i]}; }
  /// Of all obstacles, in no order; until one is added or removed.
  std::vector<ObstacleId> obstacles() const;

 private:
  /// All but what points to it.
  struct Parts {
    const collision::Kernels* kernels;
    Structure structure;
    Bodies bodies;
    std::variant<LinearSet, ExtentMasks, BoxTree> set;
    std::size_t size_when_built;
  };

  explicit ObstacleWorld(Parts parts);
  void look();
  Slot slot_of(ObstacleId obstacle) const;
  bool touches_exactly(const Vec2& from_m, const Vec2& to_m, double radius_m) const;

  Parts parts_;
  collision::WorldView view_{};
  collision::SweepKernel sweep_ = nullptr;
};

}  // namespace sidestep
