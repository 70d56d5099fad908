// SPDX-License-Identifier: Apache-2.0
#include "common/map/pgm_image.hpp"

#include <fmt/format.h>
#include <vector>

#include "common/map/image_size.hpp"

namespace sidestep {
namespace {

constexpr long kMaxSample = 65'535;

bool is_space(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Reads a decimal number up to `max`, after white space and, in the header, comments.
long read_number(std::istream& file, const char* what, long max, bool has_comments) {
  int c = file.get();
  while (is_space(c) || (has_comments && c == '#')) {
    if (c == '#')
      while (c != '\n' && c != '\r' && file) c = file.get();
    c = file.get();
  }
  if (!file) throw MapImageError(fmt::format("it ends before its {}", what));
  long value = 0;
  for (; c >= '0' && c <= '9'; c = file.get()) {
    value = 10 * value + (c - '0');
    if (value > max) throw MapImageError(fmt::format("its {} is larger than {}", what, max));
  }
  // A number must be followed by one white space or the end of the file.
  if (file && !is_space(c)) throw MapImageError(fmt::format("its {} is not a number", what));
  return value;
}

[[noreturn]] void fail_truncated() { throw MapImageError("it is truncated: pixels are missing"); }

/// Reads the samples of a row of raw pixels, of one or two bytes each.
void read_raw_row(std::istream& file, bool is_wide, std::vector<char>& bytes, std::vector<long>& samples) {
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) fail_truncated();
  const auto byte = [&](std::size_t i) { return long{static_cast<unsigned char>(bytes[i])}; };
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = is_wide ? 256 * byte(2 * i) + byte(2 * i + 1) : byte(i);
}

}  // namespace

ImageCells read_pgm(std::istream& file, const StateOf& state_of, UnknownCells unknown) {
  char magic[2] = {};
  file.read(magic, sizeof(magic));
  const bool is_plain = magic[1] == '2';
  const long columns = read_number(file, "width", kMaxSample, true);
  const long rows = read_number(file, "height", kMaxSample, true);
  const long max_sample = read_number(file, "maximum sample", kMaxSample, true);
  check_image_size(columns, rows);
  if (max_sample < 1) throw MapImageError("its maximum sample is 0");
  const bool is_wide = max_sample > 255;
  // A plain sample takes at least two characters; the last one may lack its white space.
  if (bytes_left(file) + (is_plain ? 1 : 0) < columns * rows * (is_plain || is_wide ? 2 : 1))
    fail_truncated();

  std::vector<MapCellState> states;
  for (long sample = 0; sample <= max_sample; ++sample)
    states.push_back(state_of(static_cast<double>(sample) / static_cast<double>(max_sample)));
  ImageCells cells{BitGrid(static_cast<int>(columns), static_cast<int>(rows))};
  std::vector<char> bytes(static_cast<std::size_t>(columns * (is_wide ? 2 : 1)));
  std::vector<long> samples(static_cast<std::size_t>(columns));
  for (int row = static_cast<int>(rows) - 1; row >= 0; --row) {
    if (is_plain)
      for (long& sample : samples) sample = read_number(file, "pixel", kMaxSample, false);
    else
      read_raw_row(file, is_wide, bytes, samples);
    for (int column = 0; column < cells.blocked.columns(); ++column) {
      const long sample = samples[static_cast<std::size_t>(column)];
      if (sample > max_sample)
        throw MapImageError(fmt::format("a pixel is {}, but its maximum sample is {}", sample, max_sample));
      set_cell(cells, column, row, states[static_cast<std::size_t>(sample)], unknown);
    }
  }
  return cells;
}

}  // namespace sidestep
