// SPDX-License-Identifier: Apache-2.0
#include "common/map/distance_field.hpp"

#include <numbers>

#include "common/map/distance_transform.hpp"

namespace sidestep {
namespace {

constexpr std::int32_t kMaxCells = 2'047, kMaxSquare = kMaxCells * kMaxCells;
/// Bound of the rounding error of a stored distance, in steps: half a step plus the errors of single
/// precision.
constexpr double kStepError = 0.52;
constexpr int kMaxBoundsOfAPath = 64;

}  // namespace

DistanceField::DistanceField(const OccupancyMap& map)
    : grid_(map.grid()),
      size_m_(map.extent().max_m - grid_.origin_m),
      cells_per_m_(1 / grid_.resolution_m),
      m_per_step_(grid_.resolution_m / kSteps),
      margin_m_(kStepError * m_per_step_ + grid_.resolution_m / std::numbers::sqrt2 + kRounding_m),
      distances_(static_cast<std::size_t>(grid_.columns) * static_cast<std::size_t>(grid_.rows)) {
  distance_transform(map.blocked(), [&](int row, std::span<const std::int32_t> squared) {
    std::uint16_t* const out = distances_.data() + static_cast<std::size_t>(row) * squared.size();
    for (std::size_t x = 0; x < squared.size(); ++x) {
      const auto square = static_cast<float>(squared[x] < kMaxSquare ? squared[x] : kMaxSquare);
      out[x] = static_cast<std::uint16_t>(static_cast<std::int32_t>(kSteps * std::sqrt(square) + 0.5F));
    }
  });
}

bool DistanceField::is_clear(const Vec2& from, const Vec2& to, double radius_m) const {
  if (!(radius_m >= 0)) return false;
  const Vec2 path = to - from;
  const double length_m = path.norm();
  double along_m = 0;
  for (int i = 0; i < kMaxBoundsOfAPath; ++i) {
    const Vec2 at = length_m > 0 ? Vec2(from + along_m / length_m * path) : from;
    const double free_m = lower_bound_m(at) - radius_m;
    if (!(free_m > 0)) return false;
    if (free_m > length_m - along_m) return true;
    along_m += free_m;
  }
  return false;
}

}  // namespace sidestep
