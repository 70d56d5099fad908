// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sidestep {

/// Reads numbers from the front of a byte sequence. Once there are too few bytes left, everything it returns
/// is 0 or empty, and is_valid() is false.
class NumberReader {
 public:
  using Bytes = std::span<const std::uint8_t>;

  NumberReader(Bytes bytes, bool is_little_endian) : left_(bytes), is_little_endian_(is_little_endian) {}

  bool is_valid() const { return is_valid_; }
  bool is_at_end() const { return is_valid_ && left_.empty(); }
  std::size_t left() const { return left_.size(); }

  Bytes take(std::size_t count) {
    is_valid_ = is_valid_ && count <= left_.size();
    const Bytes taken = left_.first(is_valid_ ? count : 0);
    left_ = left_.subspan(taken.size());
    return taken;
  }
  std::uint32_t number(std::size_t size) {
    std::uint32_t result = 0;
    const Bytes bytes = take(size);
    for (std::size_t i = 0; i < bytes.size(); ++i)
      result = result << 8 | bytes[is_little_endian_ ? bytes.size() - 1 - i : i];
    return result;
  }
  /// Reads a sequence number, high half first. Outside [min, limit) it is invalid, and 0 is returned.
  std::int64_t sequence_number(std::int64_t min, std::int64_t limit) {
    const std::uint32_t high = number(4), low = number(4);
    const auto result = static_cast<std::int64_t>(std::uint64_t{high} << 32 | low);
    is_valid_ = is_valid_ && result >= min && result < limit;
    return is_valid_ ? result : 0;
  }
  /// Reads an entity id, whose byte order is fixed.
  std::uint32_t identifier() {
    std::uint32_t result = 0;
    for (const std::uint8_t byte : take(4)) result = result << 8 | byte;
    return result;
  }
  /// Reads bytes that are preceded by their count and padded to a multiple of four.
  Bytes counted_bytes() {
    const std::uint32_t count = number(4);
    const Bytes result = take(count);
    take((4 - count % 4) % 4);
    return is_valid_ ? result : Bytes();
  }
  /// Skips a count of bits, at most 256, and the words that hold them.
  void skip_bitmap() {
    constexpr std::uint32_t kMaxBits = 256;
    const std::uint32_t bits = number(4);
    is_valid_ = is_valid_ && bits <= kMaxBits;
    take((bits + 31) / 32 * 4);
  }
  /// Skips parameters up to the end of the list (RTPS 2.2, 9.4.2.11).
  void skip_parameters() {
    constexpr std::uint32_t kEnd = 1;
    while (is_valid_) {
      const std::uint32_t id = number(2), size = number(2);
      if (id == kEnd) return;
      is_valid_ = is_valid_ && size % 4 == 0;
      take(size);
    }
  }

 private:
  Bytes left_;
  bool is_little_endian_;
  bool is_valid_ = true;
};

}  // namespace sidestep
