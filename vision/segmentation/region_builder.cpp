// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/region_builder.hpp"

#include <algorithm>
#include <limits>

namespace sidestep {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void RegionBuilder::begin_frame() {
  row_.clear();
  row_above_.clear();
  regions_.clear();
}

std::uint32_t RegionBuilder::root_of(std::uint32_t region) {
  while (regions_[region].parent != region) {
    regions_[region].parent = regions_[regions_[region].parent].parent;
    region = regions_[region].parent;
  }
  return region;
}

std::uint32_t RegionBuilder::united(std::uint32_t a, std::uint32_t b) {
  if (a == b) return a;
  // The older region becomes the parent: finish() counts down, and so reaches children before their parents.
  if (b < a) std::swap(a, b);
  regions_[b].parent = a;
  return a;
}

/// Returns the region of a run: the union of the regions that it touches in the row above, or a new region.
/// `above` is the index of the first run above that it may touch, and advances from run to run.
std::uint32_t RegionBuilder::region_for(const Run& run, std::size_t& above) {
  while (above < row_above_.size() && row_above_[above].end_px < run.begin_px) ++above;
  std::uint32_t region = kNone;
  for (std::size_t i = above; i < row_above_.size() && row_above_[i].begin_px <= run.end_px; ++i) {
    if (row_above_[i].region == kNone) continue;
    const std::uint32_t touched = root_of(row_above_[i].region);
    region = region == kNone ? touched : united(region, touched);
  }
  if (region != kNone) return region;
  if (regions_.size() == kMaxRegions) return kNone;
  const auto created = static_cast<std::uint32_t>(regions_.size());
  constexpr int kMax = std::numeric_limits<int>::max();
  regions_.push_back({created, 0, 0, 0, kMax, -kMax, kMax, -kMax});
  return created;
}

void RegionBuilder::add(const Run& run, int y_px) {
  Sums& sums = regions_[run.region];
  const auto length = static_cast<std::uint32_t>(run.end_px - run.begin_px);
  sums.area_px += length;
  sums.x_px += static_cast<std::uint64_t>(run.begin_px + run.end_px - 1) * length / 2;
  sums.y_px += static_cast<std::uint64_t>(y_px) * length;
  sums.left_px = std::min(sums.left_px, run.begin_px);
  sums.right_px = std::max(sums.right_px, run.end_px - 1);
  sums.top_px = std::min(sums.top_px, y_px);
  sums.bottom_px = y_px;
}

void RegionBuilder::end_row(int y_px) {
  std::size_t above = 0;
  for (Run& run : row_) {
    run.region = region_for(run, above);
    if (run.region != kNone) add(run, y_px);
  }
  std::swap(row_, row_above_);
  row_.clear();
}

void RegionBuilder::finish(std::uint32_t colour, std::uint32_t min_area_px, std::vector<Region>& regions) {
  for (std::size_t i = regions_.size(); i-- > 0;) {
    const Sums& part = regions_[i];
    if (part.parent == i) continue;
    Sums& whole = regions_[part.parent];
    whole.area_px += part.area_px;
    whole.x_px += part.x_px;
    whole.y_px += part.y_px;
    whole.left_px = std::min(whole.left_px, part.left_px);
    whole.right_px = std::max(whole.right_px, part.right_px);
    whole.top_px = std::min(whole.top_px, part.top_px);
    whole.bottom_px = std::max(whole.bottom_px, part.bottom_px);
  }
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const Sums& sums = regions_[i];
    if (sums.parent != i || sums.area_px < min_area_px) continue;
    const auto area = static_cast<double>(sums.area_px);
    regions.push_back({colour, sums.area_px, static_cast<double>(sums.x_px) / area,
                       static_cast<double>(sums.y_px) / area, sums.left_px, sums.right_px, sums.top_px,
                       sums.bottom_px});
  }
  // The two rows are swapped after every row: equal capacities avoid later allocations.
  const std::size_t capacity = std::max(row_.capacity(), row_above_.capacity());
  row_.reserve(capacity);
  row_above_.reserve(capacity);
}

}  // namespace sidestep
