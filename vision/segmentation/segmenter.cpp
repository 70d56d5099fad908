// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/segmenter.hpp"

#include <bit>

#include "vision/segmentation/batch/dispatch.hpp"

namespace sidestep {
namespace {

using namespace segmentation;

template <typename Do>
void for_each_bit(std::uint32_t bits, Do what) {
  for (; bits != 0; bits &= bits - 1) what(static_cast<std::size_t>(std::countr_zero(bits)));
}

void repeat(Repeated& row, std::uint8_t even, std::uint8_t odd) {
  for (std::size_t i = 0; i < sizeof row.bytes; ++i) row.bytes[i] = i % 2 == 0 ? even : odd;
}

std::uint8_t span_of(std::uint8_t low, std::uint8_t high) { return static_cast<std::uint8_t>(high - low); }

Thresholds thresholds_of(const ColourBox& box) {
  const std::uint8_t y = span_of(box.low.y, box.high.y), u = span_of(box.low.u, box.high.u),
                     v = span_of(box.low.v, box.high.v);
  Thresholds t;
  t.colour = box.colour;
  repeat(t.y_low, box.low.y, box.low.y);
  repeat(t.y_span, y, y);
  repeat(t.u_low, box.low.u, box.low.u);
  repeat(t.u_span, u, u);
  repeat(t.v_low, box.low.v, box.low.v);
  repeat(t.v_span, v, v);
  repeat(t.uv_low, box.low.u, box.low.v);
  repeat(t.uv_span, u, v);
  return t;
}

void add_to(Repeated& coarse, std::uint8_t low, std::uint8_t high, std::uint8_t bit) {
  for (std::size_t i = 0; i < sizeof coarse.bytes; ++i) {
    const std::size_t upper = i % 16;
    if (low / 16 <= upper && upper <= high / 16) coarse.bytes[i] |= bit;
  }
}

void add_to(Coarse& coarse, const ColourBox& box, std::size_t k) {
  const auto bit = static_cast<std::uint8_t>(1 << k % 8);
  add_to(coarse.y, box.low.y, box.high.y, bit);
  add_to(coarse.u, box.low.u, box.high.u, bit);
  add_to(coarse.v, box.low.v, box.high.v, bit);
}

void add_runs_of(std::uint64_t bits, int begin_px, RegionBuilder& builder) {
  while (bits != 0) {
    const int first = std::countr_zero(bits);
    const int length = std::countr_one(bits >> first);
    builder.add_run(begin_px + first, begin_px + first + length);
    // A sum would overflow where the run reaches the end of the word: then nothing is left.
    bits = first + length == 64 ? 0 : bits & (~std::uint64_t{0} << (first + length));
  }
}

}  // namespace

Segmenter::Segmenter(const ColourClasses& classes, const SegmentationSettings& settings)
    : Segmenter(classes, settings, best_kernels()) {}

Segmenter::Segmenter(const ColourClasses& classes, const SegmentationSettings& settings,
                     const Kernels& kernels)
    : classes_(classes), settings_(settings), kernels_(kernels) {
  for (const ColourBox& box : classes.boxes()) {
    add_to(coarse_, box, thresholds_.size());
    colours_ |= std::uint32_t{1} << box.colour;
    thresholds_.push_back(thresholds_of(box));
  }
}

ClassesView Segmenter::view() const {
  return {classes_.y().data(),
          classes_.u().data(),
          classes_.v().data(),
          thresholds_.data(),
          thresholds_.size(),
          colours_,
          &coarse_};
}

void Segmenter::add_runs(std::size_t words, int y_px) {
  for (std::size_t word = 0; word < words; ++word) {
    if (any_[word] == 0) continue;
    for_each_bit(colours_, [&](std::size_t colour) {
      add_runs_of(masks_[word * kMasks + colour], static_cast<int>(word * kWord), builders_[colour]);
    });
  }
  for_each_bit(colours_, [&](std::size_t colour) {
    if (builders_[colour].has_runs()) builders_[colour].end_row(y_px);
  });
}

std::span<const Region> Segmenter::segment(const ImageView& image) {
  const auto width = static_cast<std::size_t>(image.width_px);
  const std::size_t words = (width + kWord - 1) / kWord;
  if (any_.size() < words) {
    any_.resize(words);
    masks_.resize(words * kMasks);
  }
  const ClassesView classes = view();
  const ClassifyRow classify = image.format == PixelFormat::kRgb ? kernels_.rgb : kernels_.yuv422;
  for (RegionBuilder& builder : builders_) builder.begin_frame();
  for (int y_px = 0; y_px < image.height_px; ++y_px) {
    classify(classes, image.row(y_px), width, {any_.data(), masks_.data()});
    add_runs(words, y_px);
  }
  regions_.clear();
  for_each_bit(colours_, [&](std::size_t colour) {
    builders_[colour].finish(static_cast<std::uint32_t>(colour), settings_.least_area_px, regions_);
  });
  merge_by_density(regions_, settings_.merge);
  return regions_;
}

std::uint64_t Segmenter::left_out() const {
  std::uint64_t sum = 0;
  for (const RegionBuilder& builder : builders_) sum += builder.left_out();
  return sum;
}

}  // namespace sidestep
