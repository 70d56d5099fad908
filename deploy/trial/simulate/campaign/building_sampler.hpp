// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/geometry/field.hpp"
#include "common/map/floor_map.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// Samples a map that covers a field: rooms, corridors, doors and shelves, and some single blocked cells, as
/// in maps made with a laser. Discs of `radius_m` fit through all doors with a few centimetres to spare.
[[nodiscard]] std::shared_ptr<const FloorMap> sample_building(const Field& field, double radius_m, Rng& rng);

}  // namespace sidestep
