// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/collision_table.hpp"

#include <algorithm>
#include <cstring>

namespace sidestep {
namespace {

// Sixteen bytes, the width of SSE2 and NEON; a tile has four of these.
typedef std::uint8_t SixteenBytes __attribute__((vector_size(16)));
constexpr std::size_t kVectors = kTileSlots / sizeof(SixteenBytes);

SixteenBytes bytewise_min(const SixteenBytes& a, const SixteenBytes& b) { return a < b ? a : b; }

}  // namespace

CollisionTable::CollisionTable(const CellTimes& times, const Quantiser& quantiser)
    : grid_(times.grid), quantiser_(quantiser), place_(times.grid.size(), kOutOfReach) {
  std::vector<std::size_t> stored;
  for (std::size_t cell = 0; cell < grid_.size(); ++cell) {
    if (times.touches_hull[cell]) {
      place_[cell] = kOnHull;
    } else if (std::ranges::any_of(times.of(cell), [&](float t) { return t < times.horizon_s; })) {
      place_[cell] = static_cast<std::int32_t>(stored.size());
      stored.push_back(cell);
    }
  }
  cells_ = stored.size();
  table_.resize(kTiles * cells_);
  last_query_.assign(cells_, 0);
  found_.reserve(cells_);
  for (std::size_t tile = 0; tile < kTiles; ++tile) {
    for (std::size_t place = 0; place < cells_; ++place) {
      const auto exact = times.of(stored[place]).subspan(tile * kTileSlots, kTileSlots);
      std::ranges::transform(exact, table_[tile * cells_ + place].numbers,
                             [&](float t) { return quantiser_.encode(t); });
    }
  }
}

void CollisionTable::find_cells(std::span<const Vec2> points_m, std::vector<Vec2>& exact) {
  if (++query_ == 0) {  // the counter has wrapped
    std::ranges::fill(last_query_, 0U);
    query_ = 1;
  }
  found_.clear();
  for (const Vec2& point : points_m) {
    const std::optional<std::size_t> cell = grid_.cell_of(point);
    if (!cell || place_[*cell] == kOutOfReach) continue;
    if (place_[*cell] == kOnHull) {
      exact.push_back(point);
      continue;
    }
    const auto place = static_cast<std::uint32_t>(place_[*cell]);
    if (last_query_[place] == query_) continue;
    last_query_[place] = query_;
    found_.push_back(place);
  }
}

void CollisionTable::minimum(std::span<const Vec2> points_m, const GridWindow& window, VelocityTimes& times_s,
                             std::vector<Vec2>& exact) {
  find_cells(points_m, exact);
  for_each_tile(window, [&](std::size_t tile) {
    SixteenBytes least[kVectors];
    std::memset(least, 0xff, sizeof least);
    const Line* lines = table_.data() + tile * cells_;
    for (const std::uint32_t place : found_) {
      SixteenBytes line[kVectors];
      std::memcpy(line, &lines[place], sizeof line);
      for (std::size_t i = 0; i < kVectors; ++i) least[i] = bytewise_min(least[i], line[i]);
    }
    std::uint8_t numbers[kTileSlots];
    std::memcpy(numbers, least, sizeof numbers);
    for (std::size_t i = 0; i < kTileSlots; ++i)
      times_s[tile * kTileSlots + i] = quantiser_.decode(numbers[i]);
  });
}

std::optional<float> CollisionTable::time_s(std::size_t cell, std::size_t slot) const {
  const std::int32_t place = place_[cell];
  if (place == kOnHull) return std::nullopt;
  if (place == kOutOfReach) return quantiser_.decode(static_cast<std::uint8_t>(Quantiser::kLevels - 1));
  const std::size_t line = slot / kTileSlots * cells_ + static_cast<std::size_t>(place);
  return quantiser_.decode(table_[line].numbers[slot % kTileSlots]);
}

}  // namespace sidestep
