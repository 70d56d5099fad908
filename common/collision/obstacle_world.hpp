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

/// The search structure with which a world finds the obstacles that a query may touch.
enum class Structure {
  kAutomatic,  ///< chosen by the number of obstacles
  kLinear,     ///< see LinearSet
  kMasks,      ///< see ExtentMasks
  kTree,       ///< see BoxTree
};

/// The obstacle nearest to a point. In an empty world: kNoObstacle, infinitely far.
struct Nearest {
  double distance_m = std::numeric_limits<double>::infinity();  ///< distance to the boundary, negative inside
  ObstacleId obstacle = kNoObstacle;
};

/// The first contact of a moving disc.
struct Contact {
  double fraction = 0;  ///< free fraction of the path, 0 to 1
  ObstacleId obstacle = kNoObstacle;
};

/// A set of obstacles for contact and distance queries. Shapes touch if they have a point in common.
/// Obstacles are added, moved and removed without rebuilding the structure for the others. Const functions
/// are thread-safe and, except obstacles(), do not allocate. Functions throw std::invalid_argument for
/// non-finite numbers, negative radii, invalid shapes (see check()) and unused ids.
class ObstacleWorld {
 public:
  explicit ObstacleWorld(std::vector<Shape> shapes = {}, Structure structure = Structure::kAutomatic);
  /// Uses the kernels of a given instruction set, for tests and benchmarks.
  ObstacleWorld(std::vector<Shape> shapes, Structure structure, const collision::Kernels& kernels);

  ObstacleWorld(const ObstacleWorld& other) : ObstacleWorld(Parts(other.parts_)) {}
  ObstacleWorld& operator=(const ObstacleWorld& other);

  /// Whether a disc at a position touches an obstacle.
  bool touches(const Vec2& at_m, double radius_m) const { return touches(at_m, at_m, radius_m); }
  /// Whether a disc that moves straight from one position to another touches an obstacle.
  bool touches(const Vec2& from_m, const Vec2& to_m, double radius_m) const {
    const collision::SweepResult result = sweep_(view_, from_m.data(), to_m.data(), radius_m);
    if (result == collision::SweepResult::kUndecided) [[unlikely]]
      return touches_exactly(from_m, to_m, radius_m);
    return result == collision::SweepResult::kTouches;
  }
  /// The first contact of a disc that moves in a straight line; nullopt if the whole path is free. Contacts
  /// within rounding error may be reported either way.
  std::optional<Contact> first_contact(const Vec2& from_m, const Vec2& to_m, double radius_m) const;
  Nearest nearest(const Vec2& at_m) const;

  /// Adds an obstacle. The constructor's shapes have the ids 0, 1, 2, … in order.
  ObstacleId add(Shape shape);
  void move(ObstacleId obstacle, const Vec2& by_m);
  void remove(ObstacleId obstacle);

  std::size_t size() const { return parts_.store.slots().size(); }
  bool has(ObstacleId obstacle) const { return parts_.store.has(static_cast<Slot>(obstacle)); }
  const Shape& shape(ObstacleId obstacle) const;
  /// The i-th of size() obstacles, in no particular order; changes when obstacles are added or removed.
  ObstacleId obstacle(std::size_t i) const { return ObstacleId{parts_.store.slots()[i]}; }
  /// The ids of all obstacles, in no particular order.
  std::vector<ObstacleId> obstacles() const;

 private:
  /// All members except view_, which points into them.
  struct Parts {
    const collision::Kernels* kernels;
    Structure structure;
    ShapeStore store;
    std::variant<LinearSet, ExtentMasks, BoxTree> set;
    std::size_t size_when_built;
  };

  explicit ObstacleWorld(Parts parts);
  void update_view();
  Slot slot_of(ObstacleId obstacle) const;
  bool touches_exactly(const Vec2& from_m, const Vec2& to_m, double radius_m) const;

  Parts parts_;
  collision::WorldView view_{};
  collision::SweepKernel sweep_ = nullptr;
};

}  // namespace sidestep
