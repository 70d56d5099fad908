// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/terrain_tree.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Hilly, rough terrain on a grid with a spacing of 1 m.
inline HeightField random_terrain(Rng& rng, std::size_t columns, std::size_t rows) {
  HeightField field{
      {-0.5 * static_cast<double>(columns), -0.5 * static_cast<double>(rows)}, 1, columns, rows, {}};
  const double slope = rng.uniform(0.1, 0.5), phase = rng.uniform(0, 6);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const double x = static_cast<double>(column), y = static_cast<double>(row);
      field.heights_m.push_back(3 * std::sin(slope * x + phase) * std::cos(slope * y) + rng.uniform(0, 0.7));
    }
  }
  return field;
}

inline Vec3 random_position_above(Rng& rng, const HeightField& field) {
  return {field.corner_m.x() * rng.uniform(-1, 1), field.corner_m.y() * rng.uniform(-1, 1),
          rng.uniform(-3, 8)};
}

}  // namespace sidestep
