// SPDX-License-Identifier: Apache-2.0
#include "common/image/picture_size.hpp"

#include <algorithm>
#include <cstddef>

namespace sidestep {
namespace {

using namespace std::string_view_literals;

std::uint8_t byte_at(std::string_view bytes, std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); }

/// Reads a big-endian number. Precondition: there are enough bytes.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | byte_at(bytes, at + i);
  return value;
}

/// The first chunk contains the size (PNG specification, 11.2.2).
std::optional<PictureSize> png_size(std::string_view bytes) {
  constexpr std::size_t kChunk = 8, kWidth = kChunk + 8, kHeight = kWidth + 4;
  if (bytes.size() < kHeight + 4 || bytes.substr(kChunk, 8) != "\0\0\0\x0dIHDR"sv) return std::nullopt;
  return PictureSize{number_at(bytes, kWidth, 4), number_at(bytes, kHeight, 4)};
}

/// The segment that begins the frame contains the size (ITU-T T.81, B.2.2).
std::optional<PictureSize> jpeg_size(std::string_view bytes) {
  for (std::size_t at = 2;;) {
    if (at >= bytes.size() || byte_at(bytes, at) != 0xff) return std::nullopt;
    while (at < bytes.size() && byte_at(bytes, at) == 0xff) ++at;  // a marker may begin with several 0xff
    if (at + 8 > bytes.size()) return std::nullopt;
    const std::uint8_t marker = byte_at(bytes, at++);
    const bool is_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame) return PictureSize{number_at(bytes, at + 5, 2), number_at(bytes, at + 3, 2)};
    const bool has_segment = marker == 0xc4 || marker == 0xcc || marker == 0xdb || marker == 0xdd ||
                             (marker >= 0xe0 && marker <= 0xef) || marker == 0xfe;
    const std::uint64_t size = number_at(bytes, at, 2);
    if (!has_segment || size < 2) return std::nullopt;
    at += size;
  }
}

/// Width and height follow the format as decimal numbers, after white space and comments.
std::optional<PictureSize> pnm_size(std::string_view bytes) {
  bytes.remove_prefix(2);
  const auto take_number = [&]() -> std::optional<std::uint64_t> {
    while (!bytes.empty() && " \t\n\v\f\r#"sv.find(bytes[0]) != std::string_view::npos) {
      const std::size_t end = bytes[0] == '#' ? bytes.find_first_of("\r\n") : 0;
      if (end == std::string_view::npos) return std::nullopt;
      bytes.remove_prefix(end + 1);
    }
    constexpr std::size_t kMaxDigits = 9;
    const std::size_t digits = std::min(bytes.find_first_not_of("0123456789"), bytes.size());
    if (digits == 0 || digits > kMaxDigits) return std::nullopt;
    std::uint64_t value = 0;
    for (const char digit : bytes.substr(0, digits))
      value = 10 * value + static_cast<std::uint64_t>(digit - '0');
    bytes.remove_prefix(digits);
    return value;
  };
  const auto width_px = take_number();
  const auto height_px = width_px ? take_number() : std::nullopt;
  return height_px ? std::optional(PictureSize{*width_px, *height_px}) : std::nullopt;
}

}  // namespace

std::optional<PictureSize> stated_size(std::string_view picture) {
  if (picture.starts_with("\x89PNG\r\n\x1a\n"sv)) return png_size(picture);
  if (picture.starts_with("\xff\xd8"sv)) return jpeg_size(picture);
  if (picture.size() > 2 && picture[0] == 'P' && picture[1] >= '1' && picture[1] <= '6')
    return pnm_size(picture);
  return std::nullopt;
}

}  // namespace sidestep
