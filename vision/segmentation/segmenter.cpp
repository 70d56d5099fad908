// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/segmenter.hpp"

#include <bit>
#include <limits>

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

/// The upper halves of the numbers that boxes allow: bit i for i.
struct UpperHalves {
  std::array<std::uint32_t, 3> of{};  ///< of Y, U and V

  void add(const ColourBox& box) {
    const auto range = [](std::uint8_t low, std::uint8_t high) {
      return (2U << high / 16) - (1U << low / 16);
    };
    of[0] |= range(box.low.y, box.high.y);
    of[1] |= range(box.low.u, box.high.u);
    of[2] |= range(box.low.v, box.high.v);
  }
  /// How many pairs of U and V they allow.
  int pairs() const { return std::popcount(of[1]) * std::popcount(of[2]); }
};

/// Puts a box into a group that allows what it does, else into an empty one, and when there is none into that
/// which thereby allows least more. Returns the group's bit.
std::uint32_t joined(std::array<UpperHalves, 8>& groups, const ColourBox& box) {
  std::size_t best = 0;
  int least = std::numeric_limits<int>::max();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    UpperHalves with = groups[g];
    with.add(box);
    const int allowed = groups[g].pairs();
    const int more = allowed == 0 ? 1 : with.pairs() - allowed;
    if (more < least) {
      best = g;
      least = more;
    }
  }
  groups[best].add(box);
  return std::uint32_t{1} << best;
}

void set_bits(Repeated& coarse, std::uint32_t upper_halves, std::uint8_t bit) {
  for (std::size_t i = 0; i < sizeof coarse.bytes; ++i) {
    if ((upper_halves >> i % 16 & 1) != 0) coarse.bytes[i] |= bit;
  }
}

Coarse coarse_of(const std::array<UpperHalves, 8>& groups) {
  Coarse coarse{};
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto bit = static_cast<std::uint8_t>(1 << g);
    set_bits(coarse.y, groups[g].of[0], bit);
    set_bits(coarse.u, groups[g].of[1], bit);
    set_bits(coarse.v, groups[g].of[2], bit);
  }
  return coarse;
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
  std::array<UpperHalves, 8> groups;
  for (const ColourBox& box : classes.boxes()) {
    colours_ |= std::uint32_t{1} << box.colour;
    thresholds_.push_back(thresholds_of(box));
    thresholds_.back().group = joined(groups, box);
  }
  coarse_ = coarse_of(groups);
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
