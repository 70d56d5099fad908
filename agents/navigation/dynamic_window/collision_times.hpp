// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "agents/navigation/dynamic_window/collision_table.hpp"

namespace sidestep {

/// How times to collision are computed.
enum class CollisionMethod {
  kExact,         ///< every point against every velocity; the reference method
  kUniformTable,  ///< a table with one byte per entry, in uniform steps
  kLloydMaxTable  ///< a table with steps adapted to the times (Lloyd, Max)
};

/// The minimum times to collision with points, for the velocities of a window. `Outline` represents the
/// robot. It provides `touches(point)`, and `time_to_collision_s(point, slot)` for each permitted velocity.
template <typename Outline>
class CollisionTimes {
 public:
  /// `compute` returns the CellTimes, and is called only if a table is needed.
  template <typename ComputeCellTimes>
  CollisionTimes(Outline outline, CollisionMethod method, float horizon_s, ComputeCellTimes compute)
      : outline_(std::move(outline)), horizon_s_(horizon_s) {
    if (method == CollisionMethod::kExact) return;
    const CellTimes cells = compute();
    table_.emplace(cells, method == CollisionMethod::kUniformTable
                              ? Quantiser::uniform(horizon_s)
                              : Quantiser::lloyd_max(cells.times_s, horizon_s));
  }

  /// Computes the times for the velocities of a window, up to the horizon. A velocity whose time is at most
  /// its time in `needed_s` is inadmissible; its computed time may be only an upper bound. Returns false if a
  /// point touches the outline. Skips points that are not finite. Does not allocate once warm.
  [[nodiscard]] bool compute(std::span<const Vec2> points_m, const GridWindow& window,
                             const VelocityTimes& needed_s) {
    exact_.clear();
    if (table_) {
      table_->minimum(points_m, window, times_s_, exact_);
    } else {
      times_s_.fill(horizon_s_);
      for (const Vec2& point : points_m) {
        if (point.allFinite()) exact_.push_back(point);
      }
    }
    for (const Vec2& point : exact_) {
      if (outline_.touches(point)) return false;
    }
    for_each_velocity(window, [&](int, int, std::size_t slot) {
      for (const Vec2& point : exact_) {
        if (times_s_[slot] <= needed_s[slot]) break;
        const double time_s = outline_.time_to_collision_s(point, slot);
        // Rounds down: the stored time must never be later than the exact time.
        if (time_s < static_cast<double>(times_s_[slot]))
          times_s_[slot] = std::nextafter(static_cast<float>(time_s), 0.0F);
      }
    });
    return true;
  }

  float time_s(std::size_t slot) const { return times_s_[slot]; }
  const Outline& outline() const { return outline_; }
  /// The look-up table; nullopt with the exact method.
  const std::optional<CollisionTable>& table() const { return table_; }

 private:
  Outline outline_;
  float horizon_s_;
  std::optional<CollisionTable> table_;
  VelocityTimes times_s_{};
  std::vector<Vec2> exact_;
};

/// Value in `needed_s` that forbids a velocity, because no time to collision is long enough.
inline constexpr float kForbidden_s = std::numeric_limits<float>::infinity();

}  // namespace sidestep
