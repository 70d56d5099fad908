// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/map/floor_map.hpp"
#include "common/yaml/yaml_map.hpp"

namespace sidestep {

/// Reads the optional list `obstacles` of a scenario or of a world of `sidestep plan`; see
/// deploy/scenarios/README.md. A wall becomes a rectangle for each of its pieces. Throws ConfigError for the
/// first error.
[[nodiscard]] std::vector<Shape> read_obstacles(YamlMap& map, std::size_t max_count);

/// An example of a list element for error messages: "circle: {centre_m: [0, 0], radius_m: 1}".
[[nodiscard]] std::string obstacle_text(const Shape& shape);

/// Reads the optional keys `map` and `unknown` of a scenario or world. `map` is the path of a map's YAML
/// file, relative to the file that has the key; `unknown` says how unknown cells are treated. If `cells` is
/// given, it is used as the map, and no file is read. Throws ConfigError.
[[nodiscard]] std::shared_ptr<const FloorMap> read_floor_map(YamlMap& map,
                                                             const OccupancyMap* cells = nullptr);

}  // namespace sidestep
