// SPDX-License-Identifier: Apache-2.0
#include "common/map/png_image.hpp"

#include <fmt/format.h>
#include <iterator>
#include <png.h>
#include <string_view>
#include <vector>

#include "common/map/image_size.hpp"
#include "common/map/map_grid.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kSignatureSize = 8, kChunkOverhead = 12;
/// Enough for 64 bits per pixel without compression.
constexpr long kMaxFileBytes = 8 * kMaxMapCells;
/// Deflate compresses at most 1032 to 1, and a pixel has at least one bit.
constexpr long kMaxPixelsPerByte = 8 * 1032;
/// gAMA chunks contain 100,000 / gamma. libpng leaves samples unchanged if gamma is within 5 % of sRGB's.
constexpr std::uint32_t kMinGamma = 44'000, kMaxGamma = 47'000;

std::uint32_t big_endian(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

/// Rejects an image that libpng would brighten or darken, because it could then show unknown cells as free.
void check_gamma(const std::string& bytes) {
  for (std::size_t at = kSignatureSize; at + kChunkOverhead <= bytes.size();) {
    const std::uint32_t size = big_endian(&bytes[at]);
    const std::string_view type(&bytes[at + 4], 4);
    if (type == "IDAT" || size > bytes.size() - at - kChunkOverhead) return;
    if (type == "gAMA" && size == 4) {
      const std::uint32_t gamma = big_endian(&bytes[at + 8]);
      if (gamma < kMinGamma || gamma > kMaxGamma)
        throw MapImageError(fmt::format("its gAMA chunk is {}, expected none or sRGB's 45455", gamma));
    }
    at += kChunkOverhead + size;
  }
}

/// Frees libpng's memory for an image.
struct PngImage : png_image {
  PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  ~PngImage() { png_image_free(this); }

  void require(int success) const {
    if (success == 0 || PNG_IMAGE_FAILED(*this))
      throw MapImageError(fmt::format("it is not a valid PNG image: {}", message));
  }
};

}  // namespace

ImageCells read_png(std::istream& file, const StateOf& state_of, UnknownCells unknown) {
  constexpr int kChannels = 4;
  if (bytes_left(file) > kMaxFileBytes) throw MapImageError("the file is too large for a map");
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  check_gamma(bytes);
  PngImage image;
  image.require(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  check_image_size(static_cast<long>(image.width), static_cast<long>(image.height));
  const auto columns = static_cast<int>(image.width), rows = static_cast<int>(image.height);
  if (long{columns} * rows / kMaxPixelsPerByte > static_cast<long>(bytes.size()))
    throw MapImageError("it is truncated: pixels are missing");
  image.format = PNG_FORMAT_RGBA;
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  std::vector<png_byte> pixels(PNG_IMAGE_SIZE(image));
  image.require(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));

  std::vector<MapCellState> states;
  for (int sum = 0; sum <= 3 * 255; ++sum) states.push_back(state_of(sum / (3 * 255.0)));
  ImageCells cells{BitGrid(columns, rows)};
  const png_byte* pixel = pixels.data();
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = 0; column < columns; ++column, pixel += kChannels) {
      const auto sum = static_cast<std::size_t>(pixel[0] + pixel[1] + pixel[2]);
      set_cell(cells, column, row, pixel[3] == 255 ? states[sum] : MapCellState::kUnknown, unknown);
    }
  }
  return cells;
}

}  // namespace sidestep
