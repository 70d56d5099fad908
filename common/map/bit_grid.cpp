// SPDX-License-Identifier: Apache-2.0
#include "common/map/bit_grid.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr std::uint64_t kAllBits = ~std::uint64_t{0};

}  // namespace

BitGrid::BitGrid(int columns, int rows)
    : columns_(columns), rows_(rows), words_per_row_((columns + 63) / 64) {
  if (columns <= 0 || rows <= 0) throw std::invalid_argument("a grid needs at least one column and one row");
  words_.resize(index(0, rows));
}

void BitGrid::set_run(int begin, int end, int row, bool value) {
  for (int at = begin; at < end;) {
    const int stop = std::min(end, (at | 63) + 1);
    const std::uint64_t mask = (kAllBits >> (64 - (stop - at))) << (at & 63);
    std::uint64_t& bits = words_[index(at >> 6, row)];
    bits = value ? bits | mask : bits & ~mask;
    at = stop;
  }
}

int BitGrid::find(int begin, int end, int row, std::uint64_t flip) const {
  if (begin >= end) return end;
  int at = begin >> 6;
  std::uint64_t bits = (word(at, row) ^ flip) & (kAllBits << (begin & 63));
  while (bits == 0) {
    if (64 * ++at >= end) return end;
    bits = word(at, row) ^ flip;
  }
  return std::min(end, 64 * at + std::countr_zero(bits));
}

int BitGrid::find_last_set(int begin, int last, int row) const {
  if (begin < last) return last - 1;
  int at = begin >> 6;
  std::uint64_t bits = word(at, row) & (kAllBits >> (63 - (begin & 63)));
  while (bits == 0) {
    if (64 * at <= last) return last - 1;
    bits = word(--at, row);
  }
  return std::max(last - 1, 64 * at + 63 - std::countl_zero(bits));
}

}  // namespace sidestep
