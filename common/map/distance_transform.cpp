// SPDX-License-Identifier: Apache-2.0
#include "common/map/distance_transform.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace sidestep {
namespace {

/// Distance within a column that has no blocked cell; greater than any other.
constexpr std::uint16_t kFar = 16'384;

/// Eight masks, one per bit: 0 for blocked cells, and all ones for free cells.
using Masks = std::array<std::uint16_t, 8>;
constexpr std::array<Masks, 256> kMasks = [] {
  std::array<Masks, 256> masks{};
  for (unsigned bits = 0; bits < masks.size(); ++bits)
    for (unsigned i = 0; i < 8; ++i) masks[bits][i] = (bits >> i & 1) != 0 ? 0 : 0xffff;
  return masks;
}();

void unpack_row(const BitGrid& blocked, int row, std::vector<std::uint16_t>& masks) {
  std::uint16_t* out = masks.data();
  for (int i = 0; i < blocked.words_per_row(); ++i) {
    const std::uint64_t word = blocked.word(i, row);
    for (int byte = 0; byte < 8; ++byte, out += 8)
      std::memcpy(out, kMasks[word >> (8 * byte) & 0xff].data(), sizeof(Masks));
  }
}

/// For each cell, the distance in rows to the nearest blocked cell at or below it in the same column.
std::vector<std::uint16_t> distances_down(const BitGrid& blocked) {
  const auto columns = static_cast<std::size_t>(blocked.columns());
  std::vector<std::uint16_t> distances(columns * static_cast<std::size_t>(blocked.rows()));
  std::vector<std::uint16_t> masks(64 * static_cast<std::size_t>(blocked.words_per_row()));
  std::vector<std::uint16_t> below(columns, kFar);
  for (int row = 0; row < blocked.rows(); ++row) {
    unpack_row(blocked, row, masks);
    std::uint16_t* const out = distances.data() + static_cast<std::size_t>(row) * columns;
    for (std::size_t x = 0; x < columns; ++x) {
      const auto next = static_cast<std::uint16_t>(below[x] + 1);
      below[x] = std::min(next, kFar) & masks[x];
    }
    std::memcpy(out, below.data(), columns * sizeof(std::uint16_t));
  }
  return distances;
}

/// The pass over one row; its memory is reused for the next row. Within a run of equal column distances, each
/// cell's nearest blocked cell is in its own column or in the range of a parabola at the end of a run, so
/// only the ends of runs need parabolas.
class RowPass {
 public:
  explicit RowPass(std::size_t columns)
      : xs_(columns), heights_(columns), lasts_(columns), squared_(columns) {}

  std::span<const std::int32_t> squared(const std::vector<std::uint16_t>& in_column) {
    const std::size_t size = find_hull(in_column);
    if (size == 0)
      std::fill(squared_.begin(), squared_.end(), kNoBlockedCell);
    else
      evaluate(in_column, size);
    return squared_;
  }

 private:
  /// The corners of the lower convex hull, from left to right; returns their number.
  std::size_t find_hull(const std::vector<std::uint16_t>& in_column) {
    std::size_t size = 0;
    const std::size_t last = in_column.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      const std::uint16_t distance = in_column[i];
      const bool is_inside_run =
          i > 0 && i < last && in_column[i - 1] == distance && in_column[i + 1] == distance;
      if (is_inside_run || distance == kFar) continue;
      const auto x = static_cast<std::int32_t>(i);
      const std::int32_t height = x * x + distance * distance;
      while (size >= 2 && !is_convex(size, x, height)) --size;
      xs_[size] = x;
      heights_[size++] = height;
    }
    return size;
  }

  /// Whether the last corner lies below the line from the corner before it to a new corner.
  bool is_convex(std::size_t size, std::int32_t x, std::int32_t height) const {
    const std::int32_t last_x = xs_[size - 1], last_height = heights_[size - 1];
    return std::int64_t{last_height - heights_[size - 2]} * (x - last_x) <
           std::int64_t{height - last_height} * (last_x - xs_[size - 2]);
  }

  /// Writes the minimum of the envelope and the distance within the cell's own column. Corner i has the
  /// lowest parabola up to the column where the next one becomes lower.
  void evaluate(const std::vector<std::uint16_t>& in_column, std::size_t size) {
    for (std::size_t i = 0; i + 1 < size; ++i) {
      const std::int32_t rise = heights_[i + 1] - heights_[i];
      // The quotient of two integers below 2^31 in double precision is never rounded up to an integer.
      lasts_[i] = rise < 0 ? -1 : static_cast<std::int32_t>(rise / (2.0 * (xs_[i + 1] - xs_[i])));
    }
    const auto columns = static_cast<std::int32_t>(squared_.size());
    lasts_[size - 1] = columns - 1;
    const std::uint16_t* const distances = in_column.data();
    std::int32_t* const out = squared_.data();
    for (std::int32_t x = 0, corner = 0; x < columns; ++corner) {
      const auto i = static_cast<std::size_t>(corner);
      const std::int32_t end = std::min(lasts_[i] + 1, columns), twice = 2 * xs_[i], height = heights_[i];
      for (; x < end; ++x) {
        const std::int32_t own = distances[x] == kFar ? kNoBlockedCell : distances[x] * distances[x];
        const std::int32_t other = x * (x - twice) + height;
        out[x] = other < own ? other : own;
      }
    }
  }

  std::vector<std::int32_t> xs_, heights_;  // indexed by corner; heights are x² + distance²
  std::vector<std::int32_t> lasts_;         // indexed by corner: last column where its parabola is lowest
  std::vector<std::int32_t> squared_;
};

}  // namespace

void distance_transform(const BitGrid& blocked, const DistanceRowHandler& take) {
  const std::vector<std::uint16_t> down = distances_down(blocked);
  const auto columns = static_cast<std::size_t>(blocked.columns());
  std::vector<std::uint16_t> nearest(columns, kFar);
  RowPass pass(columns);
  for (int row = blocked.rows() - 1; row >= 0; --row) {
    const std::uint16_t* const in = down.data() + static_cast<std::size_t>(row) * columns;
    for (std::size_t x = 0; x < columns; ++x)
      nearest[x] = std::min(in[x], static_cast<std::uint16_t>(nearest[x] + 1));
    take(row, pass.squared(nearest));
  }
}

}  // namespace sidestep
