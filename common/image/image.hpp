// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace sidestep {

/// The layout of pixels in memory, row by row from the top, each row from the left.
enum class PixelFormat : std::uint8_t {
  kYuv422,  ///< UYVY: two pixels share U and V; full-range ITU-R BT.601
  kRgb      ///< R G B per pixel
};

/// The name used in files and on the command line.
constexpr std::string_view name_of(PixelFormat format) {
  return format == PixelFormat::kRgb ? "rgb" : "yuv422";
}
/// nullopt for an unknown name.
[[nodiscard]] constexpr std::optional<PixelFormat> pixel_format_named(std::string_view name) {
  for (const PixelFormat format : {PixelFormat::kYuv422, PixelFormat::kRgb}) {
    if (name == name_of(format)) return format;
  }
  return std::nullopt;
}

constexpr int bytes_per_pixel(PixelFormat format) { return format == PixelFormat::kRgb ? 3 : 2; }

/// A non-owning view of an image. With kYuv422 the width is even.
struct ImageView {
  PixelFormat format = PixelFormat::kYuv422;
  int width_px = 0;
  int height_px = 0;
  const std::uint8_t* pixels = nullptr;  ///< contiguous rows

  std::size_t row_bytes() const {
    return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(bytes_per_pixel(format));
  }
  std::size_t bytes() const { return row_bytes() * static_cast<std::size_t>(height_px); }
  const std::uint8_t* row(int y) const { return pixels + row_bytes() * static_cast<std::size_t>(y); }
};

/// An owning image.
class Image {
 public:
  Image() = default;
  /// All bytes are zero. Preconditions: the sizes are not negative, and the width is even with kYuv422.
  Image(PixelFormat format, int width_px, int height_px)
      : format_(format),
        width_px_(width_px),
        height_px_(height_px),
        pixels_(ImageView{format, width_px, height_px}.bytes()) {}

  ImageView view() const { return {format_, width_px_, height_px_, pixels_.data()}; }
  std::uint8_t* pixels() { return pixels_.data(); }
  std::uint8_t* row(int y) { return pixels_.data() + view().row_bytes() * static_cast<std::size_t>(y); }

 private:
  PixelFormat format_ = PixelFormat::kYuv422;
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace sidestep
