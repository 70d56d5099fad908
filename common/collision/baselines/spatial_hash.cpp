// SPDX-License-Identifier: Apache-2.0
#include "common/collision/baselines/spatial_hash.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace sidestep::baselines {
namespace {

constexpr std::uint64_t kMaxCells = 64;  // maximum number of cells of one obstacle
constexpr double kMaxCell = 0x1p30;
constexpr double kUnused_m = std::numeric_limits<double>::quiet_NaN();
const Box kUnusedBox{{kUnused_m, kUnused_m}, {kUnused_m, kUnused_m}};

}  // namespace

SpatialHash::SpatialHash(const ShapeStore& store) : origin_m_(store.origin_m()) {
  const std::size_t size = store.slots().size();
  heads_.assign(std::bit_ceil(4 * size + 1), kNone);
  if (size == 0) return;
  Box all = bounds(store.shape(store.slots().front()));
  double sum_m = 0;
  for (const Slot slot : store.slots()) {
    const Box box = bounds(store.shape(slot));
    all = united(all, box);
    sum_m += (box.max_m - box.min_m).maxCoeff();
  }
  const auto count = static_cast<double>(size);
  const Vec2 range_m = all.max_m - all.min_m;
  const double width_m = std::max(sum_m / count, std::sqrt(range_m.x() * range_m.y() / count));
  if (width_m > 1e-12) cells_per_m_ = 1 / width_m;
  for (const Slot slot : store.slots()) add(slot, store.shape(slot));
}

/// The cell number of a coordinate, which increases with the coordinate. Coordinates far from the origin
/// share a cell.
std::int32_t SpatialHash::cell(double at_m) const {
  return static_cast<std::int32_t>(std::clamp(std::floor(at_m * cells_per_m_), -kMaxCell, kMaxCell));
}

SpatialHash::CellRange SpatialHash::cells_of(const Box& box) const {
  const Vec2 low = box.min_m - origin_m_, high = box.max_m - origin_m_;
  return {cell(low.x()), cell(low.y()), cell(high.x()), cell(high.y())};
}

void SpatialHash::add(Slot slot, const Shape& shape) {
  if (slot >= boxes_.size()) {
    boxes_.resize(slot + 1, kUnusedBox);
    ranges_.resize(slot + 1);
  }
  boxes_[slot] = bounds(shape);
  const CellRange range = cells_of(boxes_[slot]);
  if (range.count() > kMaxCells) {
    large_.push_back(slot);
    return;
  }
  ranges_[slot] = range;
  for (std::int32_t y = range.min_y; y <= range.max_y; ++y)
    for (std::int32_t x = range.min_x; x <= range.max_x; ++x) insert(x, y, slot);
}

void SpatialHash::replace(Slot slot, const Shape& shape) {
  remove(slot);
  add(slot, shape);
}

void SpatialHash::remove(Slot slot) {
  const CellRange range = ranges_[slot];
  if (range.count() == 0) large_.erase(std::find(large_.begin(), large_.end(), slot));
  for (std::int32_t y = range.min_y; y <= range.max_y; ++y)
    for (std::int32_t x = range.min_x; x <= range.max_x; ++x) erase(x, y, slot);
  ranges_[slot] = {};
  boxes_[slot] = kUnusedBox;
}

void SpatialHash::insert(std::int32_t x, std::int32_t y, Slot slot) {
  if (used_entries_ > heads_.size()) grow();
  std::uint32_t i = free_entry_;
  if (i == kNone) {
    i = static_cast<std::uint32_t>(entries_.size());
    entries_.emplace_back();
  } else {
    free_entry_ = entries_[i].next;
  }
  std::uint32_t& head = heads_[bucket(x, y)];
  entries_[i] = {x, y, slot, head};
  head = i;
  ++used_entries_;
}

void SpatialHash::erase(std::int32_t x, std::int32_t y, Slot slot) {
  std::uint32_t* link = &heads_[bucket(x, y)];
  const auto is_it = [&](const Entry& entry) { return entry.x == x && entry.y == y && entry.slot == slot; };
  while (!is_it(entries_[*link])) link = &entries_[*link].next;
  const std::uint32_t i = *link;
  *link = entries_[i].next;
  entries_[i].next = free_entry_;
  free_entry_ = i;
  --used_entries_;
}

void SpatialHash::grow() {
  const std::vector<std::uint32_t> lists(2 * heads_.size(), kNone);
  for (const std::uint32_t first : std::exchange(heads_, lists)) {
    for (std::uint32_t i = first; i != kNone;) {
      const std::uint32_t next = entries_[i].next;
      std::uint32_t& head = heads_[bucket(entries_[i].x, entries_[i].y)];
      entries_[i].next = head;
      head = i;
      i = next;
    }
  }
}

}  // namespace sidestep::baselines
