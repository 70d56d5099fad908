// SPDX-License-Identifier: Apache-2.0
// From a frame to regions of five colours: our inner loops, OpenCV's ways, and copying the frame, side by
// side in one run. OpenCV gets the frame as the numbers that thresholds are about, for nothing. Regions have
// to agree.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <fmt/core.h>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <string>

#include "common/random/rng.hpp"
#include "vision/segmentation/batch/dispatch.hpp"
#include "vision/segmentation/segmenter.hpp"

using namespace sidestep;

namespace {

constexpr int kRounds = 41;
constexpr std::uint64_t kSeed = 1;
constexpr SegmentationSettings kAll{1, {0.5, -1}};

/// Red, green and blue of orange, yellow, blue, green and pink.
const std::vector<cv::Scalar> kPaints{
    {235, 110, 40}, {230, 210, 50}, {40, 70, 210}, {60, 220, 70}, {240, 70, 180}};

/// A field with two teams of eleven, a ball, white lines, and a little noise everywhere.
Image field(int width_px, int height_px) {
  Image image(PixelFormat::kRgb, width_px, height_px);
  cv::Mat canvas(height_px, width_px, CV_8UC3, image.pixels());
  canvas.setTo(cv::Scalar(60, 100, 50));
  const double scale = width_px / 640.0;
  const cv::Scalar white(225, 225, 225), black(25, 25, 25);
  cv::rectangle(canvas, cv::Rect(width_px / 12, height_px / 12, width_px * 10 / 12, height_px * 10 / 12),
                white, std::max(1, static_cast<int>(2 * scale)));
  cv::circle(canvas, {width_px / 2, height_px / 2}, height_px / 8, white,
             std::max(1, static_cast<int>(2 * scale)));
  Rng rng(kSeed);
  const auto dot = [&](double x, double y, double radius, const cv::Scalar& colour) {
    cv::circle(canvas, cv::Point(static_cast<int>(x), static_cast<int>(y)),
               std::max(1, static_cast<int>(radius)), colour, cv::FILLED);
  };
  for (int robot = 0; robot < 22; ++robot) {
    const double x = (40 + 56 * (robot % 11)) * scale, y = (robot < 11 ? 0.3 : 0.7) * height_px;
    dot(x, y, 11 * scale, black);
    dot(x, y, 3 * scale, kPaints[robot < 11 ? 1 : 2]);
    for (const auto& [dx, dy] : {std::pair{5, 7}, {5, -7}, {-7, 5}, {-7, -5}}) {
      dot(x + dx * scale, y + dy * scale, 2.5 * scale, kPaints[3 + rng.below(2)]);
    }
  }
  dot(0.5 * width_px, 0.5 * height_px, 2.5 * scale, kPaints[0]);
  for (std::size_t i = 0; i < image.view().bytes(); ++i) {
    const double noisy = image.pixels()[i] + 2.5 * rng.normal();
    image.pixels()[i] = static_cast<std::uint8_t>(std::clamp(noisy, 0.0, 255.0));
  }
  return image;
}

/// The same in 4:2:2; colours are ours, not those of a standard.
Image subsampled(const ImageView& rgb) {
  Image image(PixelFormat::kYuv422, rgb.width_px, rgb.height_px);
  for (int y = 0; y < rgb.height_px; ++y) {
    for (int x = 0; x < rgb.width_px; x += 2) {
      const Yuv left = pixel_at(rgb, x, y), right = pixel_at(rgb, x + 1, y);
      const std::uint8_t pair[4] = {left.u, left.y, left.v, right.y};
      std::memcpy(image.row(y) + 2 * static_cast<std::ptrdiff_t>(x), pair, sizeof pair);
    }
  }
  return image;
}

std::vector<ColourBox> boxes() {
  std::vector<ColourBox> made;
  const auto around = [](int value, int reach, std::uint8_t& low, std::uint8_t& high) {
    low = static_cast<std::uint8_t>(std::max(0, value - reach));
    high = static_cast<std::uint8_t>(std::min(255, value + reach));
  };
  for (const cv::Scalar& paint : kPaints) {
    Image one(PixelFormat::kRgb, 1, 1);
    for (int i = 0; i < 3; ++i) one.pixels()[i] = static_cast<std::uint8_t>(paint[i]);
    const Yuv yuv = pixel_at(one.view(), 0, 0);
    ColourBox box;
    box.colour = static_cast<std::uint32_t>(made.size());
    around(yuv.y, 40, box.low.y, box.high.y);
    around(yuv.u, 20, box.low.u, box.high.u);
    around(yuv.v, 20, box.low.v, box.high.v);
    made.push_back(box);
  }
  return made;
}

cv::Scalar scalar(const Yuv& yuv) { return cv::Scalar(yuv.y, yuv.u, yuv.v); }

cv::Mat planes(const ImageView& image) {
  cv::Mat yuv(image.height_px, image.width_px, CV_8UC3);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const Yuv p = pixel_at(image, x, y);
      yuv.at<cv::Vec3b>(y, x) = {p.y, p.u, p.v};
    }
  }
  return yuv;
}

using Regions = std::vector<Region>;

Regions with_components(const cv::Mat& yuv, const std::vector<ColourBox>& colours) {
  Regions regions;
  cv::Mat mask, labels, stats, centroids;
  for (std::uint32_t k = 0; k < colours.size(); ++k) {
    cv::inRange(yuv, scalar(colours[k].low), scalar(colours[k].high), mask);
    const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 8, CV_32S);
    for (int i = 1; i < count; ++i) {
      const int *s = stats.ptr<int>(i), left = s[cv::CC_STAT_LEFT], top = s[cv::CC_STAT_TOP];
      regions.push_back({k, static_cast<std::uint32_t>(s[cv::CC_STAT_AREA]), centroids.at<double>(i, 0),
                         centroids.at<double>(i, 1), left, left + s[cv::CC_STAT_WIDTH] - 1, top,
                         top + s[cv::CC_STAT_HEIGHT] - 1});
    }
  }
  return regions;
}

/// Contours tell the outline only: area and middle are left 0.
Regions with_contours(const cv::Mat& yuv, const std::vector<ColourBox>& colours) {
  Regions regions;
  cv::Mat mask;
  std::vector<std::vector<cv::Point>> contours;
  std::vector<cv::Vec4i> hierarchy;
  for (std::uint32_t k = 0; k < colours.size(); ++k) {
    cv::inRange(yuv, scalar(colours[k].low), scalar(colours[k].high), mask);
    cv::findContours(mask, contours, hierarchy, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
    for (std::size_t i = 0; i < contours.size(); ++i) {
      if (hierarchy[i][3] >= 0) continue;  // a hole
      const cv::Rect box = cv::boundingRect(contours[i]);
      regions.push_back({k, 0, 0, 0, box.x, box.x + box.width - 1, box.y, box.y + box.height - 1});
    }
  }
  return regions;
}

Regions sorted(Regions regions) {
  std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) {
    return std::tie(a.colour, a.top_px, a.left_px, a.right_px, a.bottom_px) <
           std::tie(b.colour, b.top_px, b.left_px, b.right_px, b.bottom_px);
  });
  return regions;
}

Regions outlines(Regions regions) {
  for (Region& region : regions) region.area_px = 0, region.x_px = region.y_px = 0;
  return regions;
}

struct Side {
  std::string name;
  std::function<void()> run;
  std::vector<double> times_ms{};
  double median_ms() {
    std::sort(times_ms.begin(), times_ms.end());
    return times_ms[times_ms.size() / 2];
  }
};

/// All sides in turn, round by round, each once before it is timed. Ratios are to the first one.
void compare(const std::string& what, std::size_t bytes, std::vector<Side> sides) {
  for (int round = 0; round < kRounds; ++round) {
    for (Side& side : sides) {
      side.run();  // whatever the one before has left in the caches
      const auto begin = std::chrono::steady_clock::now();
      side.run();
      const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
      side.times_ms.push_back(taken.count());
    }
  }
  const double base_ms = sides.front().median_ms();
  for (Side& side : sides) {
    const double ms = side.median_ms();
    fmt::print("{:<18} {:<32}{:9.3f}{:9.2f}{:9.1f}\n", what, side.name, ms, ms / base_ms,
               static_cast<double>(bytes) / ms / 1e6);
  }
}

bool bench(int width_px, int height_px, PixelFormat format) {
  Image image = field(width_px, height_px);
  if (format == PixelFormat::kYuv422) image = subsampled(image.view());
  const ImageView view = image.view();
  const std::vector<ColourBox> colours = boxes();
  const cv::Mat yuv = planes(view);
  const Regions components = sorted(with_components(yuv, colours));
  bool agree = sorted(with_contours(yuv, colours)) == outlines(components);

  const auto& levels = segmentation::available_kernels();
  std::vector<Segmenter> segmenters;
  for (const auto& kernels : levels) {
    segmenters.emplace_back(ColourClasses(colours), kAll, kernels);
    const auto regions = segmenters.back().segment(view);
    agree &= sorted({regions.begin(), regions.end()}) == components;
  }
  std::vector<Side> sides;
  for (std::size_t i = levels.size(); i-- > 0;) {
    sides.push_back({fmt::format("ours, {}", levels[i].name), [&, i] { segmenters[i].segment(view); }});
  }
  Image copy = image;
  sides.push_back({"copying the frame", [&] { std::memcpy(copy.pixels(), view.pixels, view.bytes()); }});
  sides.push_back({"OpenCV inRange, contours", [&] { with_contours(yuv, colours); }});
  sides.push_back({"OpenCV inRange, components", [&] { with_components(yuv, colours); }});
  const char* name = format == PixelFormat::kRgb ? "RGB" : "4:2:2";
  compare(fmt::format("{}x{} {}", width_px, height_px, name), view.bytes(), sides);
  fmt::print("{} regions, {}\n\n", components.size(), agree ? "the same on all sides" : "NOT THE SAME");
  return agree;
}

}  // namespace

int main() {
  cv::setNumThreads(1);
  fmt::print("{:<18} {:<32}{:>9}{:>9}{:>9}\n", "frame", "", "ms", "ratio", "GB/s");
  bool agree = true;
  for (const auto& [width_px, height_px] : {std::pair{640, 480}, {780, 580}, {1920, 1080}, {2448, 2048}}) {
    for (const PixelFormat format : {PixelFormat::kRgb, PixelFormat::kYuv422}) {
      agree &= bench(width_px, height_px, format);
    }
  }
  return agree ? 0 : 1;
}
