// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/building_sampler.hpp"

#include <algorithm>
#include <vector>

#include "tests/catch.hpp"

namespace sidestep::building_sampler_test {

/// The largest connected part of the places where a disc fits, as a fraction of all of them. Grid neighbours
/// are connected if the disc fits between them.
double largest_connected_fraction(const OccupancyMap& map, const Field& field, double radius_m,
                                  double step_m) {
  const int columns = static_cast<int>(field.length_m / step_m),
            rows = static_cast<int>(field.width_m / step_m);
  const auto place = [&](int index) {
    return Vec2((index % columns + 0.5) * step_m - field.length_m / 2,
                (index / columns + 0.5) * step_m - field.width_m / 2);
  };
  std::vector<bool> is_seen(static_cast<std::size_t>(columns * rows));
  int free = 0, largest = 0;
  for (int first = 0; first < columns * rows; ++first) {
    if (is_seen[static_cast<std::size_t>(first)] || map.touches(place(first), place(first), radius_m))
      continue;
    std::vector<int> open{first};
    is_seen[static_cast<std::size_t>(first)] = true;
    int size = 0;
    while (!open.empty()) {
      const int at = open.back();
      open.pop_back();
      ++size;
      for (const auto& [x, y] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
        const int column = at % columns + x, row = at / columns + y;
        if (column < 0 || column >= columns || row < 0 || row >= rows) continue;
        const int next = row * columns + column;
        if (is_seen[static_cast<std::size_t>(next)] || map.touches(place(at), place(next), radius_m))
          continue;
        is_seen[static_cast<std::size_t>(next)] = true;
        open.push_back(next);
      }
    }
    free += size;
    largest = std::max(largest, size);
  }
  return static_cast<double>(largest) / free;
}

TEST_CASE("a random building's map covers the floor and is centred on it") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Field field{rng.uniform(4, 12), rng.uniform(4, 12)};
    const MapGrid& grid = sample_building(field, 0.09, rng)->cells().grid();
    const Vec2 size_m = grid.resolution_m * Vec2(grid.columns, grid.rows);
    CHECK((grid.origin_m + size_m / 2).norm() < 1e-9);
    CHECK(size_m.x() >= field.length_m);
    CHECK(size_m.y() >= field.width_m);
    CHECK(size_m.x() < field.length_m + grid.resolution_m);
    CHECK(size_m.y() < field.width_m + grid.resolution_m);
  }
}

TEST_CASE("narrow and wide robots fit through the doors of random buildings") {
  const double radius_m = GENERATE(0.09, 0.6);
  CAPTURE(radius_m);
  double sum = 0;
  constexpr int kBuildings = 8;
  for (std::uint64_t seed = 1; seed <= kBuildings; ++seed) {
    Rng rng(seed);
    const Field field{40 * radius_m + 6, 30 * radius_m + 4};
    sum += largest_connected_fraction(sample_building(field, radius_m, rng)->cells(), field, radius_m,
                                      radius_m / 6);
  }
  CHECK(sum / kBuildings > 0.75);
}

}  // namespace sidestep::building_sampler_test
