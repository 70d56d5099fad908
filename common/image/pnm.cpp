// SPDX-License-Identifier: Apache-2.0
#include "common/image/pnm.hpp"

#include <fmt/format.h>
#include <vector>

namespace sidestep {
namespace {

constexpr long kMaxNumber = 65'535;

bool is_space(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

[[noreturn]] void fail_truncated() { throw ImageError("it is truncated: pixels are missing"); }

}  // namespace

long bytes_left(std::istream& file) {
  const std::streamoff at = file.tellg();
  file.seekg(0, std::ios::end);
  const std::streamoff end = file.tellg();
  file.seekg(at);
  return static_cast<long>(end - at);
}

PnmReader::PnmReader(std::istream& file, const ImageSizeCheck& check_size) : file_(file) {
  char magic[2] = {};
  file_.read(magic, sizeof(magic));
  is_plain_ = magic[1] == '2' || magic[1] == '3';
  channels_ = magic[1] == '3' || magic[1] == '6' ? 3 : 1;
  const long width_px = read_number("width", true);
  const long height_px = read_number("height", true);
  max_sample_ = static_cast<int>(read_number("maximum sample", true));
  check_size(width_px, height_px);
  if (max_sample_ < 1) throw ImageError("its maximum sample is 0");
  width_px_ = static_cast<int>(width_px);
  height_px_ = static_cast<int>(height_px);
  // A plain sample takes at least two characters; the last one may lack its white space.
  if (bytes_left(file_) + (is_plain_ ? 1 : 0) <
      width_px * height_px * channels_ * (is_plain_ || is_wide() ? 2 : 1))
    fail_truncated();
}

/// Reads a decimal number after white space and, in the header, comments.
long PnmReader::read_number(const char* what, bool has_comments) {
  int c = file_.get();
  while (is_space(c) || (has_comments && c == '#')) {
    if (c == '#')
      while (c != '\n' && c != '\r' && file_) c = file_.get();
    c = file_.get();
  }
  if (!file_) throw ImageError(fmt::format("it ends before its {}", what));
  long value = 0;
  for (; c >= '0' && c <= '9'; c = file_.get()) {
    value = 10 * value + (c - '0');
    if (value > kMaxNumber) throw ImageError(fmt::format("its {} is larger than {}", what, kMaxNumber));
  }
  // A number must be followed by one white space or the end of the file.
  if (file_ && !is_space(c)) throw ImageError(fmt::format("its {} is not a number", what));
  return value;
}

/// Reads samples of one or two bytes each.
void PnmReader::read_raw(std::span<std::uint16_t> samples) {
  std::vector<char> bytes(samples.size() * (is_wide() ? 2 : 1));
  if (!file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) fail_truncated();
  const auto byte = [&](std::size_t i) { return int{static_cast<unsigned char>(bytes[i])}; };
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<std::uint16_t>(is_wide() ? 256 * byte(2 * i) + byte(2 * i + 1) : byte(i));
}

void PnmReader::read_row(std::span<std::uint16_t> samples) {
  if (is_plain_)
    for (std::uint16_t& sample : samples) sample = static_cast<std::uint16_t>(read_number("pixel", false));
  else
    read_raw(samples);
  for (const std::uint16_t sample : samples)
    if (sample > max_sample_)
      throw ImageError(fmt::format("a pixel is {}, but its maximum sample is {}", sample, max_sample_));
}

}  // namespace sidestep
