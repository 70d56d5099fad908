// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/segmenter.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/vision/segmentation/flood_fill.hpp"
#include "vision/segmentation/batch/dispatch.hpp"

namespace sidestep::segmenter_test {

constexpr SegmentationSettings kAll{1, -1};  // all regions, no merging

std::uint8_t byte(Rng& rng) { return static_cast<std::uint8_t>(rng.below(256)); }

Image noise(PixelFormat format, int width_px, int height_px, Rng& rng) {
  Image image(format, width_px, height_px);
  for (std::size_t i = 0; i < image.view().bytes(); ++i) image.pixels()[i] = byte(rng);
  return image;
}

/// A random image of equal blocks, whose regions are larger than in noise and have many shapes.
Image blocks(PixelFormat format, int width_px, int height_px, Rng& rng) {
  Image image = noise(format, width_px, height_px, rng);
  const auto step = static_cast<std::size_t>(format == PixelFormat::kRgb ? 3 : 4);
  for (int y = 0; y < height_px; ++y) {
    std::uint8_t* row = image.row(y);
    for (std::size_t i = step; i < image.view().row_bytes(); ++i) {
      if (!rng.chance(0.15)) row[i] = row[i - step];
    }
    if (y > 0 && rng.chance(0.6)) std::copy_n(image.row(y - 1), image.view().row_bytes(), row);
  }
  return image;
}

std::vector<ColourBox> boxes(std::size_t count, Rng& rng) {
  std::vector<ColourBox> random_boxes(count);
  for (ColourBox& box : random_boxes) {
    const auto sample = [&rng](std::uint8_t& low, std::uint8_t& high) {
      const std::uint8_t a = byte(rng), b = byte(rng);
      low = std::min(a, b);
      high = std::max(a, b);
    };
    sample(box.low.y, box.high.y);
    sample(box.low.u, box.high.u);
    sample(box.low.v, box.high.v);
    box.colour = static_cast<std::uint32_t>(rng.below(kMaxColours));
  }
  return random_boxes;
}

std::vector<Region> found(Segmenter& segmenter, const Image& image) {
  const auto regions = segmenter.segment(image.view());
  return {regions.begin(), regions.end()};
}

/// An image that is red where the text has an X.
Image image_of(const std::vector<std::string>& rows) {
  Image image(PixelFormat::kRgb, static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (std::size_t y = 0; y < rows.size(); ++y) {
    for (std::size_t x = 0; x < rows[y].size(); ++x) {
      image.row(static_cast<int>(y))[3 * x] = rows[y][x] == 'X' ? 255 : 0;
    }
  }
  return image;
}

const ColourBox kRed{{50, 0, 200}, {80, 255, 255}, 0};

TEST_CASE("all kernels find the same regions as flood filling") {
  const std::uint64_t seed = GENERATE(range(1, 41));
  Rng rng(seed);
  const auto format = rng.chance(0.5) ? PixelFormat::kRgb : PixelFormat::kYuv422;
  const int width_px = 2 * (1 + static_cast<int>(rng.below(150))),
            height_px = 1 + static_cast<int>(rng.below(60));
  const ColourClasses classes(boxes(1 + rng.below(kMaxColours), rng));
  const Image image =
      rng.chance(0.3) ? noise(format, width_px, height_px, rng) : blocks(format, width_px, height_px, rng);
  const std::uint32_t min_area_px = rng.chance(0.5) ? 1 : 5;
  const auto expected = flood_filled(image.view(), classes, min_area_px);
  for (const auto& kernels : segmentation::available_kernels()) {
    CAPTURE(seed, kernels.name, width_px, height_px);
    Segmenter segmenter(classes, {min_area_px, kAll.max_gap_px}, kernels);
    const auto regions = found(segmenter, image);
    CHECK(regions == expected);
    CHECK(found(segmenter, image) == regions);
  }
}

TEST_CASE("all kernels classify every RGB colour by definition") {
  // All values of red with all values of green or blue, the third component fixed.
  const auto seed = static_cast<std::uint64_t>(GENERATE(range(1, 6)));
  Rng rng(seed);
  const ColourClasses classes(boxes(8, rng));
  Image image(PixelFormat::kRgb, 256, 256);
  const std::uint8_t green = byte(rng);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      std::uint8_t* pixel = image.row(y) + 3 * static_cast<std::ptrdiff_t>(x);
      pixel[0] = static_cast<std::uint8_t>(x);
      pixel[seed % 2 == 0 ? 1 : 2] = static_cast<std::uint8_t>(y);
      pixel[seed % 2 == 0 ? 2 : 1] = green;
    }
  }
  const auto expected = flood_filled(image.view(), classes, 1);
  for (const auto& kernels : segmentation::available_kernels()) {
    CAPTURE(seed, kernels.name);
    Segmenter segmenter(classes, kAll, kernels);
    CHECK(found(segmenter, image) == expected);
  }
}

TEST_CASE("parts that are connected in a lower row form one region with a common centroid") {
  const Image image = image_of({"X...X...X",  //
                                "X...X...X",  //
                                "X..X.X..X",  //
                                ".XX...XX.",  //
                                ".........",  //
                                "....X...."});
  Segmenter segmenter(ColourClasses(std::vector{kRed}), kAll);
  const auto regions = found(segmenter, image);
  REQUIRE(regions.size() == 2);
  CHECK(regions[0] == Region{0, 14, 4.0, (0 * 3 + 1 * 3 + 2 * 4 + 3 * 4) / 14.0, 0, 8, 0, 3});
  CHECK(regions[1] == Region{0, 1, 4, 5, 4, 4, 5, 5});
}

TEST_CASE("a region split by a line is merged") {
  const Image image = image_of({".XXXXX....",  //
                                ".XXXXX....",  //
                                "..........",  //
                                ".XXXXX....",  //
                                ".XXXXX...X"});
  Segmenter unmerged(ColourClasses(std::vector{kRed}), kAll);
  CHECK(unmerged.segment(image.view()).size() == 3);
  Segmenter segmenter(ColourClasses(std::vector{kRed}), {1, 1});
  const auto regions = found(segmenter, image);
  REQUIRE(regions.size() == 2);
  CHECK(regions[0] == Region{0, 20, 3, 2, 1, 5, 0, 4});
  CHECK(regions[1].area_px == 1);
}

TEST_CASE("regions skipped as too far away are reconsidered after a merge") {
  const Image image = image_of({"XXXX....XX",  //
                                "XXXX....XX",  //
                                "XXXX.XX.XX",  //
                                "XXXX.XX.XX"});
  Segmenter segmenter(ColourClasses(std::vector{kRed}), {1, 1});
  const auto regions = found(segmenter, image);
  REQUIRE(regions.size() == 1);
  CHECK(regions[0].area_px == 28);
}

TEST_CASE("regions that do not fill their common box are not merged") {
  const Image image = image_of({"XX....",  //
                                "XX....",  //
                                "......",  //
                                "..XX..",  //
                                "..XX.."});
  Segmenter segmenter(ColourClasses(std::vector{kRed}), {1, 2});
  CHECK(segmenter.segment(image.view()).size() == 2);
}

TEST_CASE("regions of different colours are never merged") {
  Image image = image_of({"XXXX",  //
                          "XXXX"});
  for (int x = 0; x < 4; ++x) {
    image.row(1)[3 * static_cast<std::ptrdiff_t>(x)] = 0;
    image.row(1)[3 * static_cast<std::ptrdiff_t>(x) + 2] = 255;
  }
  const ColourBox blue{{50, 200, 0}, {80, 255, 255}, 1};
  Segmenter segmenter(ColourClasses(std::vector{kRed, blue}), {1, 5});
  const auto regions = found(segmenter, image);
  REQUIRE(regions.size() == 2);
  CHECK(regions[0].colour == 0);
  CHECK(regions[1].colour == 1);
}

TEST_CASE("in a noisy frame, regions beyond the limit are dropped") {
  Image image(PixelFormat::kRgb, 1000, 1000);
  for (int y = 0; y < 1000; y += 2) {
    for (int x = 0; x < 1000; x += 2) image.row(y)[3 * static_cast<std::ptrdiff_t>(x)] = 255;
  }
  Segmenter segmenter(ColourClasses(std::vector{kRed}), kAll);
  CHECK(segmenter.segment(image.view()).size() == RegionBuilder::kMaxRegions);
}

TEST_CASE("segmenting a second frame does not allocate memory") {
  Rng rng(7);
  const Image image = blocks(PixelFormat::kYuv422, 640, 100, rng);
  Segmenter segmenter(ColourClasses(boxes(5, rng)));
  segmenter.segment(image.view());
  const auto before = allocation_count();
  segmenter.segment(image.view());
  CHECK(allocation_count() == before);
}

}  // namespace sidestep::segmenter_test
