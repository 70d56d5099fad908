// SPDX-License-Identifier: Apache-2.0
// Compares methods that find the regions of five colours in a frame: all
// available kernels and two methods with OpenCV, and for reference copying the frame. OpenCV gets the frame
// already converted to the values to which thresholds apply; the conversion is not timed. Fails if regions
// differ.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <fmt/core.h>
#include <functional>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <string>

#include "common/random/rng.hpp"
#include "tests/unit/vision/detection/rendered_field.hpp"
#include "vision/segmentation/batch/dispatch.hpp"
#include "vision/segmentation/segmenter.hpp"

using namespace sidestep;

namespace {

constexpr int kRounds = 41;
constexpr std::uint64_t kSeed = 1;
constexpr SegmentationSettings kAll{1, -1};

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
  for (const ColourBox& box : colours) {
    cv::inRange(yuv, scalar(box.low), scalar(box.high), mask);
    const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 8, CV_32S);
    for (int i = 1; i < count; ++i) {
      const int *s = stats.ptr<int>(i), left = s[cv::CC_STAT_LEFT], top = s[cv::CC_STAT_TOP];
      regions.push_back({box.colour, static_cast<std::uint32_t>(s[cv::CC_STAT_AREA]),
                         centroids.at<double>(i, 0), centroids.at<double>(i, 1), left,
                         left + s[cv::CC_STAT_WIDTH] - 1, top, top + s[cv::CC_STAT_HEIGHT] - 1});
    }
  }
  return regions;
}

/// Contours give only the bounding box, so area and centroid remain 0.
Regions with_contours(const cv::Mat& yuv, const std::vector<ColourBox>& colours) {
  Regions regions;
  cv::Mat mask;
  std::vector<std::vector<cv::Point>> contours;
  std::vector<cv::Vec4i> hierarchy;
  for (const ColourBox& box : colours) {
    cv::inRange(yuv, scalar(box.low), scalar(box.high), mask);
    cv::findContours(mask, contours, hierarchy, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
    for (std::size_t i = 0; i < contours.size(); ++i) {
      if (hierarchy[i][3] >= 0) continue;  // a hole
      const cv::Rect at = cv::boundingRect(contours[i]);
      regions.push_back({box.colour, 0, 0, 0, at.x, at.x + at.width - 1, at.y, at.y + at.height - 1});
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

Regions bounding_boxes(Regions regions) {
  for (Region& region : regions) region.area_px = 0, region.x_px = region.y_px = 0;
  return regions;
}

struct Contestant {
  std::string name;
  std::function<void()> run;
  std::vector<double> times_ms{};
  double median_ms() {
    std::sort(times_ms.begin(), times_ms.end());
    return times_ms[times_ms.size() / 2];
  }
};

/// Times all contestants in rounds of random order, because each finds the caches as its predecessor left
/// them. Each contestant runs once untimed before it is timed. On large frames, one run does not fully reload
/// what OpenCV evicted. Ratios are relative to the first contestant.
void compare(const std::string& frame_name, std::size_t bytes, std::vector<Contestant> contestants) {
  std::vector<std::size_t> order(contestants.size());
  std::iota(order.begin(), order.end(), 0);
  Rng rng(kSeed);
  for (int round = 0; round < kRounds; ++round) {
    rng.shuffle(order);
    for (const std::size_t i : order) {
      Contestant& contestant = contestants[i];
      contestant.run();
      const auto begin = std::chrono::steady_clock::now();
      contestant.run();
      const std::chrono::duration<double, std::milli> duration = std::chrono::steady_clock::now() - begin;
      contestant.times_ms.push_back(duration.count());
    }
  }
  const double base_ms = contestants.front().median_ms();
  for (Contestant& contestant : contestants) {
    const double ms = contestant.median_ms();
    fmt::print("{:<18} {:<32}{:9.3f}{:9.2f}{:9.1f}\n", frame_name, contestant.name, ms, ms / base_ms,
               static_cast<double>(bytes) / ms / 1e6);
  }
}

bool bench(int width_px, int height_px, PixelFormat format) {
  RenderSpec spec;
  spec.format = format;
  OverheadCamera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  test::RenderedField floor(kSeed, spec, camera);
  const std::vector<ColourBox> all = floor.learned_boxes();
  std::vector<ColourBox> colours = all;
  std::erase_if(colours, [](const ColourBox& box) { return box.colour == kOtherColour; });
  const std::vector<test::PlacedRobot> robots = floor.scattered_robots(11);
  const Image image = floor.frame(robots, floor.free_position(robots));
  const ImageView view = image.view();
  const cv::Mat yuv = planes(view);
  const Regions components = sorted(with_components(yuv, colours));
  bool agree = sorted(with_contours(yuv, colours)) == bounding_boxes(components);

  const auto& levels = segmentation::available_kernels();
  std::vector<Segmenter> segmenters;
  for (const auto& kernels : levels) {
    segmenters.emplace_back(ColourClasses(colours), kAll, kernels);
    const auto regions = segmenters.back().segment(view);
    agree &= sorted({regions.begin(), regions.end()}) == components;
  }
  std::vector<Contestant> contestants;
  for (std::size_t i = levels.size(); i-- > 0;) {
    contestants.push_back(
        {fmt::format("sidestep, {}", levels[i].name), [&, i] { segmenters[i].segment(view); }});
  }
  Segmenter with_others{ColourClasses(all), kAll};
  contestants.push_back({"fastest, with unnamed colours", [&] { with_others.segment(view); }});
  Image copy = image;
  contestants.push_back(
      {"copying the frame", [&] { std::memcpy(copy.pixels(), view.pixels, view.bytes()); }});
  contestants.push_back({"OpenCV inRange, contours", [&] { with_contours(yuv, colours); }});
  contestants.push_back({"OpenCV inRange, components", [&] { with_components(yuv, colours); }});
  const char* name = format == PixelFormat::kRgb ? "RGB" : "4:2:2";
  compare(fmt::format("{}x{} {}", width_px, height_px, name), view.bytes(), contestants);
  fmt::print("{} regions, {}\n\n", components.size(),
             agree ? "identical for all contestants" : "NOT IDENTICAL");
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
