// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/trajectory_index.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace sidestep {
namespace {

constexpr double kMinCell_m = 0.5;
constexpr double kMaxCellsAcross = 64;
// Up to this many versions share one cell.
constexpr std::size_t kMaxPerSingleCell = 64;

}  // namespace

void TrajectoryIndex::clear() {
  versions_.clear();
  bounds_.clear();
  is_built_ = false;
}

void TrajectoryIndex::add(const Version& version, const TrajectoryBounds& bounds) {
  versions_.push_back(&version);
  bounds_.push_back(bounds);
  bounds_.back().disc.radius_m += version.inflation_m;
  is_built_ = false;
}

void TrajectoryIndex::assign(std::span<const Version> versions) {
  clear();
  for (const Version& version : versions) add(version);
}

std::size_t TrajectoryIndex::column_of(double x) const {
  const double column = (x - min_m_.x()) / cell_m_;
  return static_cast<std::size_t>(std::clamp(column, 0.0, static_cast<double>(columns_ - 1)));
}

std::size_t TrajectoryIndex::row_of(double y) const {
  const double row = (y - min_m_.y()) / cell_m_;
  return static_cast<std::size_t>(std::clamp(row, 0.0, static_cast<double>(rows_ - 1)));
}

void TrajectoryIndex::build() {
  const std::size_t count = versions_.size();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  min_m_ = Vec2::Constant(kInfinity);
  Vec2 max_m = Vec2::Constant(-kInfinity);
  max_radius_m_ = 0;
  for (const TrajectoryBounds& bounds : bounds_) {
    min_m_ = min_m_.cwiseMin(bounds.disc.centre_m);
    max_m = max_m.cwiseMax(bounds.disc.centre_m);
    max_radius_m_ = std::max(max_radius_m_, bounds.disc.radius_m);
  }
  columns_ = rows_ = 1;
  if (count > kMaxPerSingleCell) {
    const Vec2 extent = max_m - min_m_;
    cell_m_ = std::max(kMinCell_m, extent.maxCoeff() / kMaxCellsAcross);
    columns_ = static_cast<std::size_t>(extent.x() / cell_m_) + 1;
    rows_ = static_cast<std::size_t>(extent.y() / cell_m_) + 1;
  }
  // Counting sort by cell.
  cell_of_.resize(count);
  cell_begin_.assign(columns_ * rows_ + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2& centre = bounds_[i].disc.centre_m;
    cell_of_[i] = static_cast<std::uint32_t>(row_of(centre.y()) * columns_ + column_of(centre.x()));
    ++cell_begin_[cell_of_[i] + 1];
  }
  for (std::size_t cell = 1; cell < cell_begin_.size(); ++cell) cell_begin_[cell] += cell_begin_[cell - 1];
  order_.resize(count);
  for (std::size_t i = count; i-- > 0;) {
    // Fills each cell from its end. Afterwards, entry cell + 1 holds the first index of the cell.
    order_[--cell_begin_[cell_of_[i] + 1]] = static_cast<std::uint32_t>(i);
  }
  // Shifts the first indices back by one entry.
  std::shift_left(cell_begin_.begin(), cell_begin_.end(), 1);
  cell_begin_.back() = static_cast<std::uint32_t>(count);

  const std::size_t blocks = (count + batch::kLanes - 1) / batch::kLanes;
  x_m_.resize(blocks);
  y_m_.resize(blocks);
  radius_m_.resize(blocks);
  masks_.resize(blocks);
  for (std::size_t i = 0; i < blocks * batch::kLanes; ++i) {
    const Circle disc = i < count ? bounds_[order_[i]].disc : Circle{};
    x_m_[i / batch::kLanes].lane[i % batch::kLanes] = disc.centre_m.x();
    y_m_[i / batch::kLanes].lane[i % batch::kLanes] = disc.centre_m.y();
    radius_m_[i / batch::kLanes].lane[i % batch::kLanes] = disc.radius_m;
  }
  is_built_ = true;
}

void TrajectoryIndex::find(const Circle& circle, std::vector<std::uint32_t>& found) {
  if (versions_.empty()) return;
  if (!is_built_) build();
  const double max_distance = circle.radius_m + max_radius_m_;
  const std::size_t left = column_of(circle.centre_m.x() - max_distance);
  const std::size_t right = column_of(circle.centre_m.x() + max_distance);
  const std::size_t top = row_of(circle.centre_m.y() + max_distance);
  for (std::size_t row = row_of(circle.centre_m.y() - max_distance); row <= top; ++row) {
    find_between(cell_begin_[row * columns_ + left], cell_begin_[row * columns_ + right + 1], circle, found);
  }
}

void TrajectoryIndex::find_between(std::size_t begin, std::size_t end, const Circle& circle,
                                   std::vector<std::uint32_t>& found) {
  if (begin == end) return;
  const std::size_t first = begin / batch::kLanes, last = (end - 1) / batch::kLanes;
  kernels_->comparison.find_touching(&x_m_[first], &y_m_[first], &radius_m_[first], last - first + 1,
                                     circle.centre_m.x(), circle.centre_m.y(), circle.radius_m,
                                     masks_.data());
  for (std::size_t block = first; block <= last; ++block) {
    unsigned mask = masks_[block - first];
    if (block == first) mask &= 0xffu << (begin % batch::kLanes);
    if (block == last) mask &= 0xffu >> (batch::kLanes - 1 - (end - 1) % batch::kLanes);
    for (; mask != 0; mask &= mask - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(mask));
      found.push_back(order_[block * batch::kLanes + lane]);
    }
  }
}

}  // namespace sidestep
