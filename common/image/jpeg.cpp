// SPDX-License-Identifier: Apache-2.0
#include "common/image/jpeg.hpp"

#include <fmt/format.h>
#include <memory>
#include <new>
#include <turbojpeg.h>

namespace sidestep {
namespace {

struct TurboJpegDeleter {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using TurboJpeg = std::unique_ptr<void, TurboJpegDeleter>;

TurboJpeg turbo_jpeg(tjhandle handle) {
  if (handle == nullptr) throw std::bad_alloc();
  return TurboJpeg(handle);
}

void require_jpeg(const TurboJpeg& turbo, int result, const char* failure) {
  if (result != 0) throw ImageError(fmt::format("{}: {}", failure, tjGetErrorStr2(turbo.get())));
}

}  // namespace

Image decode_jpeg(std::string_view bytes, const ImageSizeCheck& check_size) {
  constexpr const char* kInvalid = "it is not a valid JPEG image";
  const auto* const data = reinterpret_cast<const unsigned char*>(bytes.data());
  const TurboJpeg turbo = turbo_jpeg(tjInitDecompress());
  int width_px = 0, height_px = 0, subsampling = 0, colour_space = 0;
  require_jpeg(turbo,
               tjDecompressHeader3(turbo.get(), data, bytes.size(), &width_px, &height_px, &subsampling,
                                   &colour_space),
               kInvalid);
  // TurboJPEG reports a file that ends before its frame as a picture without pixels.
  if (width_px < 1 || height_px < 1) throw ImageError(fmt::format("{}: it has no frame", kInvalid));
  check_size(width_px, height_px);
  if (colour_space == TJCS_CMYK || colour_space == TJCS_YCCK)
    throw ImageError("it is a JPEG image in CMYK, expected colour or grey");
  Image image(PixelFormat::kRgb, width_px, height_px);
  require_jpeg(turbo,
               tjDecompress2(turbo.get(), data, bytes.size(), image.pixels(), width_px, 0, height_px,
                             TJPF_RGB, TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS),
               kInvalid);
  return image;
}

std::string encode_jpeg(const std::uint8_t* bgr, int width_px, int height_px, std::size_t row_bytes) {
  constexpr int kQuality = 95;
  const TurboJpeg turbo = turbo_jpeg(tjInitCompress());
  unsigned char* data = nullptr;
  unsigned long size = 0;
  const int result = tjCompress2(turbo.get(), bgr, width_px, static_cast<int>(row_bytes), height_px, TJPF_BGR,
                                 &data, &size, TJSAMP_420, kQuality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(data, tjFree);
  require_jpeg(turbo, result, "it cannot be encoded");
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace sidestep
