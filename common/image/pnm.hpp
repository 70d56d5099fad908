// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <span>

#include "common/image/image_error.hpp"

namespace sidestep {

/// The number of bytes from the current position of a seekable stream to its end.
[[nodiscard]] long bytes_left(std::istream& file);

/// Reads an image in PGM or PPM (Netpbm's specification: plain "P2" and "P3", raw "P5" and "P6") from a
/// seekable stream. The bytes are untrusted.
class PnmReader {
 public:
  /// Reads the header. Throws ImageError if it is invalid, or the stream is too short for all pixels.
  /// Precondition: the stream begins with one of the four formats.
  PnmReader(std::istream& file, const ImageSizeCheck& check_size);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  /// 1 with PGM (grey), 3 with PPM (R G B).
  int channels() const { return channels_; }
  int max_sample() const { return max_sample_; }

  /// Reads the next row, from the top: `width_px() * channels()` samples, none above max_sample(). Throws
  /// ImageError if it is invalid.
  void read_row(std::span<std::uint16_t> samples);

 private:
  bool is_wide() const { return max_sample_ > 255; }
  long read_number(const char* what, bool has_comments);
  void read_raw(std::span<std::uint16_t> samples);

  std::istream& file_;
  bool is_plain_ = false;
  int width_px_ = 0, height_px_ = 0, channels_ = 1, max_sample_ = 0;
};

}  // namespace sidestep
