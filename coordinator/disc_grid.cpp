// SPDX-License-Identifier: Apache-2.0
#include "coordinator/disc_grid.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// A robot's versions usually fit in a disc of half this radius.
constexpr double kMinCell_m = 1;
constexpr double kMaxCellsAcross = 64;

}  // namespace

DiscGrid::DiscGrid(const Field& field, std::size_t count)
    : low_m_(-field.length_m / 2, -field.width_m / 2),
      cell_m_(std::max(kMinCell_m, std::max(field.length_m, field.width_m) / kMaxCellsAcross)),
      columns_(static_cast<std::size_t>(field.length_m / cell_m_) + 1),
      rows_(static_cast<std::size_t>(field.width_m / cell_m_) + 1),
      cells_(columns_ * rows_ + 1),
      circles_(count),
      cell_of_(count, kNoCell) {}

// Positions outside the field belong to the cells at its border.
std::size_t DiscGrid::column_of(double x) const {
  return static_cast<std::size_t>(
      std::clamp((x - low_m_.x()) / cell_m_, 0.0, static_cast<double>(columns_ - 1)));
}

std::size_t DiscGrid::row_of(double y) const {
  return static_cast<std::size_t>(
      std::clamp((y - low_m_.y()) / cell_m_, 0.0, static_cast<double>(rows_ - 1)));
}

void DiscGrid::set(std::uint32_t disc, const Circle& circle) {
  circles_[disc] = circle;
  const Vec2& centre = circle.centre_m;
  // A NaN radius does not fit, so such a disc goes into the last cell, which every search includes.
  const bool fits = circle.radius_m <= cell_m_;
  const std::size_t cell = fits ? row_of(centre.y()) * columns_ + column_of(centre.x()) : columns_ * rows_;
  if (cell_of_[disc] == cell) return;
  remove(disc);
  cells_[cell].push_back(disc);
  cell_of_[disc] = static_cast<std::uint32_t>(cell);
}

void DiscGrid::remove(std::uint32_t disc) {
  if (cell_of_[disc] == kNoCell) return;
  std::erase(cells_[cell_of_[disc]], disc);
  cell_of_[disc] = kNoCell;
}

void DiscGrid::find(const Circle& circle, std::vector<std::uint32_t>& found) const {
  found.clear();
  const auto search_cell = [&](const std::vector<std::uint32_t>& cell) {
    for (const std::uint32_t disc : cell) {
      if (touch(circles_[disc], circle)) found.push_back(disc);
    }
  };
  const double far = circle.radius_m + cell_m_;
  const std::size_t left = column_of(circle.centre_m.x() - far);
  const std::size_t right = column_of(circle.centre_m.x() + far);
  const std::size_t top = row_of(circle.centre_m.y() + far);
  for (std::size_t row = row_of(circle.centre_m.y() - far); row <= top; ++row) {
    for (std::size_t column = left; column <= right; ++column) search_cell(cells_[row * columns_ + column]);
  }
  search_cell(cells_.back());
  std::ranges::sort(found);
}

}  // namespace sidestep
