// SPDX-License-Identifier: Apache-2.0
#include "common/image/png.hpp"

#include <fmt/format.h>
#include <png.h>

namespace sidestep {
namespace {

constexpr std::size_t kSignatureSize = 8, kChunkOverhead = 12;
/// Deflate compresses at most 1032 to 1, and a pixel has at least one bit.
constexpr std::size_t kMaxPixelsPerByte = 8 * 1032;
/// gAMA chunks contain 100,000 / gamma. libpng leaves samples unchanged if gamma is within 5 % of sRGB's.
constexpr std::uint32_t kMinGamma = 44'000, kMaxGamma = 47'000;

std::uint32_t big_endian_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (const char byte : bytes.substr(at, 4)) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

/// Rejects an image that libpng would brighten or darken: a map could then show unknown cells as free.
void check_gamma(std::string_view bytes) {
  for (std::size_t at = kSignatureSize; at + kChunkOverhead <= bytes.size();) {
    const std::uint32_t size = big_endian_at(bytes, at);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (type == "IDAT" || size > bytes.size() - at - kChunkOverhead) return;
    if (type == "gAMA" && size == 4) {
      const std::uint32_t gamma = big_endian_at(bytes, at + 8);
      if (gamma < kMinGamma || gamma > kMaxGamma)
        throw ImageError(fmt::format("its gAMA chunk is {}, expected none or sRGB's 45455", gamma));
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

  void require(int success, const char* failure) const {
    if (success == 0 || PNG_IMAGE_FAILED(*this)) throw ImageError(fmt::format("{}: {}", failure, message));
  }
};

}  // namespace

RgbaImage decode_png(std::string_view bytes, const ImageSizeCheck& check_size) {
  constexpr const char* kInvalid = "it is not a valid PNG image";
  check_gamma(bytes);
  PngImage image;
  image.require(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), kInvalid);
  check_size(static_cast<long>(image.width), static_cast<long>(image.height));
  if (std::size_t{image.width} * image.height / kMaxPixelsPerByte > bytes.size())
    throw ImageError("it is truncated: pixels are missing");
  image.format = PNG_FORMAT_RGBA;
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  RgbaImage decoded{static_cast<int>(image.width), static_cast<int>(image.height),
                    std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  image.require(png_image_finish_read(&image, nullptr, decoded.samples.data(), 0, nullptr), kInvalid);
  return decoded;
}

std::string encode_png(const std::uint8_t* bgr, int width_px, int height_px, std::size_t row_bytes) {
  if (width_px < 1 || height_px < 1) throw ImageError("the picture has no pixels");
  PngImage image;
  image.width = static_cast<png_uint_32>(width_px);
  image.height = static_cast<png_uint_32>(height_px);
  image.format = PNG_FORMAT_BGR;
  image.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  image.require(png_image_write_to_memory(&image, bytes.data(), &size, 0, bgr,
                                          static_cast<png_int_32>(row_bytes), nullptr),
                "it cannot be encoded");
  bytes.resize(size);
  return bytes;
}

}  // namespace sidestep
