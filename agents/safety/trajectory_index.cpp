// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/trajectory_index.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace sidestep {
namespace {

constexpr double kSmallestCell_m = 0.5;
constexpr double kMostCellsAcross = 64;
// So few are looked at one by one.
constexpr std::size_t kFew = 64;

}  // namespace

void TrajectoryIndex::clear() {
  versions_.clear();
  outlines_.clear();
  is_built_ = false;
}

void TrajectoryIndex::add(const Version& version, const TrajectoryBounds& outline) {
  versions_.push_back(&version);
  outlines_.push_back(outline);
  outlines_.back().disc.radius_m += version.inflation_m;
  is_built_ = false;
}

void TrajectoryIndex::assign(std::span<const Version> versions) {
  clear();
  for (const Version& version : versions) add(version);
}

std::size_t TrajectoryIndex::column_of(double x) const {
  const double column = (x - low_m_.x()) / cell_m_;
  return static_cast<std::size_t>(std::clamp(column, 0.0, static_cast<double>(columns_ - 1)));
}

std::size_t TrajectoryIndex::row_of(double y) const {
  const double row = (y - low_m_.y()) / cell_m_;
  return static_cast<std::size_t>(std::clamp(row, 0.0, static_cast<double>(rows_ - 1)));
}

void TrajectoryIndex::build() {
  const std::size_t count = versions_.size();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  low_m_ = Vec2::Constant(kInfinity);
  Vec2 high_m = Vec2::Constant(-kInfinity);
  largest_m_ = 0;
  for (const TrajectoryBounds& outline : outlines_) {
    low_m_ = low_m_.cwiseMin(outline.disc.centre_m);
    high_m = high_m.cwiseMax(outline.disc.centre_m);
    largest_m_ = std::max(largest_m_, outline.disc.radius_m);
  }
  columns_ = rows_ = 1;
  if (count > kFew) {
    const Vec2 extent = high_m - low_m_;
    cell_m_ = std::max(kSmallestCell_m, extent.maxCoeff() / kMostCellsAcross);
    columns_ = static_cast<std::size_t>(extent.x() / cell_m_) + 1;
    rows_ = static_cast<std::size_t>(extent.y() / cell_m_) + 1;
  }
  // Counting sort by cell.
  cell_of_.resize(count);
  first_of_cell_.assign(columns_ * rows_ + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2& centre = outlines_[i].disc.centre_m;
    cell_of_[i] = static_cast<std::uint32_t>(row_of(centre.y()) * columns_ + column_of(centre.x()));
    ++first_of_cell_[cell_of_[i] + 1];
  }
  for (std::size_t cell = 1; cell < first_of_cell_.size(); ++cell)
    first_of_cell_[cell] += first_of_cell_[cell - 1];
  order_.resize(count);
  for (std::size_t i = count; i-- > 0;) {
    // Filled from each cell's end, which leaves its first place in the cell after it.
    order_[--first_of_cell_[cell_of_[i] + 1]] = static_cast<std::uint32_t>(i);
  }
  // Each cell's entry now says where it begins, one place too far on.
  for (std::size_t cell = 0; cell + 1 < first_of_cell_.size(); ++cell)
    first_of_cell_[cell] = first_of_cell_[cell + 1];
  first_of_cell_.back() = static_cast<std::uint32_t>(count);

  const std::size_t blocks = (count + batch::kLanes - 1) / batch::kLanes;
  x_m_.resize(blocks);
  y_m_.resize(blocks);
  radius_m_.resize(blocks);
  masks_.resize(blocks);
  for (std::size_t i = 0; i < blocks * batch::kLanes; ++i) {
    const Circle disc = i < count ? outlines_[order_[i]].disc : Circle{};
    x_m_[i / batch::kLanes].lane[i % batch::kLanes] = disc.centre_m.x();
    y_m_[i / batch::kLanes].lane[i % batch::kLanes] = disc.centre_m.y();
    radius_m_[i / batch::kLanes].lane[i % batch::kLanes] = disc.radius_m;
  }
  is_built_ = true;
}

void TrajectoryIndex::find(const Circle& circle, std::vector<std::uint32_t>& found) {
  if (versions_.empty()) return;
  if (!is_built_) build();
  const double far = circle.radius_m + largest_m_;
  const std::size_t left = column_of(circle.centre_m.x() - far);
  const std::size_t right = column_of(circle.centre_m.x() + far);
  const std::size_t top = row_of(circle.centre_m.y() + far);
  for (std::size_t row = row_of(circle.centre_m.y() - far); row <= top; ++row) {
    find_between(first_of_cell_[row * columns_ + left], first_of_cell_[row * columns_ + right + 1], circle,
                 found);
  }
}

void TrajectoryIndex::find_between(std::size_t begin, std::size_t end, const Circle& circle,
                         std::vector<std::uint32_t>& found) {
  if (begin == end) return;
  const std::size_t first = begin / batch::kLanes, last = (end - 1) / batch::kLanes;
  kernels_->comparing.touching(&x_m_[first], &y_m_[first], &radius_m_[first], last - first + 1,
                               circle.centre_m.x(), circle.centre_m.y(), circle.radius_m, masks_.data());
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
