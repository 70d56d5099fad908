// SPDX-License-Identifier: Apache-2.0
#include "vision/segmentation/segmenter.hpp"

#include <bit>
#include <limits>

#include "vision/segmentation/batch/dispatch.hpp"

namespace sidestep {
namespace {

using namespace segmentation;

constexpr std::size_t kBoxGroups = 8;  // number of bits in a byte of CoarseTables

template <typename Visit>
void for_each_bit(std::uint32_t bits, Visit visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

void fill(VectorConstant& constant, std::uint8_t even, std::uint8_t odd) {
  for (std::size_t i = 0; i < sizeof constant.bytes; ++i) constant.bytes[i] = i % 2 == 0 ? even : odd;
}

std::uint8_t span_of(std::uint8_t low, std::uint8_t high) { return static_cast<std::uint8_t>(high - low); }

Thresholds thresholds_of(const ColourBox& box) {
  const std::uint8_t y = span_of(box.low.y, box.high.y), u = span_of(box.low.u, box.high.u),
                     v = span_of(box.low.v, box.high.v);
  Thresholds t{};
  t.colour = box.colour;
  fill(t.y_low, box.low.y, box.low.y);
  fill(t.y_span, y, y);
  fill(t.u_low, box.low.u, box.low.u);
  fill(t.u_span, u, u);
  fill(t.v_low, box.low.v, box.low.v);
  fill(t.v_span, v, v);
  fill(t.uv_low, box.low.u, box.low.v);
  fill(t.uv_span, u, v);
  return t;
}

/// The high nibbles of the values that a group of boxes accepts: bit i for nibble i.
struct HighNibbles {
  std::array<std::uint32_t, 3> of{};  ///< for Y, U and V

  void add(const ColourBox& box) {
    const auto range = [](std::uint8_t low, std::uint8_t high) {
      return (2U << high / 16) - (1U << low / 16);
    };
    of[0] |= range(box.low.y, box.high.y);
    of[1] |= range(box.low.u, box.high.u);
    of[2] |= range(box.low.v, box.high.v);
  }
  /// The number of accepted pairs of U and V nibbles.
  int pairs() const { return std::popcount(of[1]) * std::popcount(of[2]); }
};

/// Adds a box to the group whose number of accepted pairs grows least; for an empty group the growth counts
/// as one pair. Returns the group's bit.
std::uint32_t add_to_group(std::array<HighNibbles, kBoxGroups>& groups, const ColourBox& box) {
  std::size_t best = 0;
  int min_added = std::numeric_limits<int>::max();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    HighNibbles extended = groups[g];
    extended.add(box);
    const int accepted = groups[g].pairs();
    const int added = accepted == 0 ? 1 : extended.pairs() - accepted;
    if (added < min_added) {
      best = g;
      min_added = added;
    }
  }
  groups[best].add(box);
  return std::uint32_t{1} << best;
}

void set_bits(VectorConstant& table, std::uint32_t high_nibbles, std::uint8_t bit) {
  for (std::size_t i = 0; i < sizeof table.bytes; ++i) {
    if ((high_nibbles >> i % 16 & 1) != 0) table.bytes[i] |= bit;
  }
}

CoarseTables coarse_tables_of(const std::array<HighNibbles, kBoxGroups>& groups) {
  CoarseTables tables{};
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto bit = static_cast<std::uint8_t>(1 << g);
    set_bits(tables.y, groups[g].of[0], bit);
    set_bits(tables.u, groups[g].of[1], bit);
    set_bits(tables.v, groups[g].of[2], bit);
  }
  return tables;
}

void add_runs_of(std::uint64_t bits, int begin_px, RegionBuilder& builder) {
  while (bits != 0) {
    const int first = std::countr_zero(bits);
    const int length = std::countr_one(bits >> first);
    builder.add_run(begin_px + first, begin_px + first + length);
    // A run that reaches the end of the word is the last one, and shifting by 64 would be undefined.
    bits = first + length == 64 ? 0 : bits & (~std::uint64_t{0} << (first + length));
  }
}

}  // namespace

Segmenter::Segmenter(const ColourClasses& classes, const SegmentationSettings& settings)
    : Segmenter(classes, settings, best_kernels()) {}

Segmenter::Segmenter(const ColourClasses& classes, const SegmentationSettings& settings,
                     const Kernels& kernels)
    : classes_(classes), settings_(settings), kernels_(kernels) {
  std::array<HighNibbles, kBoxGroups> groups;
  for (const ColourBox& box : classes.boxes()) {
    colours_ |= std::uint32_t{1} << box.colour;
    thresholds_.push_back(thresholds_of(box));
    thresholds_.back().group = add_to_group(groups, box);
  }
  coarse_ = coarse_tables_of(groups);
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
    builders_[colour].finish(static_cast<std::uint32_t>(colour), settings_.min_area_px, regions_);
  });
  merge_by_density(regions_, settings_.max_gap_px);
  return regions_;
}

}  // namespace sidestep
