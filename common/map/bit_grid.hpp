// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace sidestep {

/// A grid of bits, stored row by row, that is searched for runs of equal bits 64 bits at a time. Precondition
/// of all functions: rows are in the grid, and so are columns unless stated otherwise.
class BitGrid {
 public:
  /// All bits are 0. Throws std::invalid_argument if either size is not positive.
  BitGrid(int columns, int rows);

  int columns() const { return columns_; }
  int rows() const { return rows_; }

  bool get(int column, int row) const { return (word(column >> 6, row) >> (column & 63) & 1) != 0; }
  void set(int column, int row) { words_[index(column >> 6, row)] |= std::uint64_t{1} << (column & 63); }
  /// Sets the columns begin, …, end - 1 to a value.
  void set_run(int begin, int end, int row, bool value = true);

  /// The first column in [begin, end) whose bit is 1; `end` if there is none. `begin` may equal `end`.
  int find_set(int begin, int end, int row) const { return find(begin, end, row, 0); }
  /// The first column in [begin, end) whose bit is 0; `end` if there is none. `begin` may equal `end`.
  int find_clear(int begin, int end, int row) const { return find(begin, end, row, ~std::uint64_t{0}); }
  /// The last column in [last, begin] whose bit is 1; `last` - 1 if there is none.
  int find_last_set(int begin, int last, int row) const;

  /// The bits of the columns 64 * index, …, 64 * index + 63. Those beyond the last column are 0.
  std::uint64_t word(int index, int row) const { return words_[this->index(index, row)]; }
  int words_per_row() const { return words_per_row_; }

  friend bool operator==(const BitGrid&, const BitGrid&) = default;

 private:
  int find(int begin, int end, int row, std::uint64_t flip) const;
  std::size_t index(int word, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(words_per_row_) +
           static_cast<std::size_t>(word);
  }

  int columns_, rows_, words_per_row_;
  std::vector<std::uint64_t> words_;
};

}  // namespace sidestep
