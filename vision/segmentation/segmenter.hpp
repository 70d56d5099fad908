// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/image/image.hpp"
#include "vision/segmentation/batch/kernels.hpp"
#include "vision/segmentation/colour_classes.hpp"
#include "vision/segmentation/region.hpp"
#include "vision/segmentation/region_builder.hpp"
#include "vision/segmentation/region_merging.hpp"

namespace sidestep {

struct SegmentationSettings {
  std::uint32_t min_area_px = 3;  ///< smaller regions are noise; applied before merging
  /// Maximum gap in columns or rows between the bounding boxes of merged regions; negative: no merging.
  int max_gap_px = 2;
};

/// Finds the colour regions of a frame in one pass: each row is classified, cut into runs and joined to the
/// regions above while it is in the cache. Pixels without a colour cost almost nothing. Allocates only if a
/// frame is wider or has more regions than all earlier frames.
class Segmenter {
 public:
  explicit Segmenter(const ColourClasses& classes, const SegmentationSettings& settings = {});
  /// Uses the given kernels instead of the fastest ones.
  Segmenter(const ColourClasses& classes, const SegmentationSettings& settings,
            const segmentation::Kernels& kernels);

  const ColourClasses& classes() const { return classes_; }
  /// Regions sorted by colour, then by top row. Valid until the next call.
  std::span<const Region> segment(const ImageView& image);

 private:
  void add_runs(std::size_t words, int y_px);

  segmentation::ClassesView view() const;

  ColourClasses classes_;
  SegmentationSettings settings_;
  segmentation::Kernels kernels_;
  std::vector<segmentation::Thresholds> thresholds_;
  segmentation::CoarseTables coarse_{};
  std::uint32_t colours_ = 0;  ///< bit c: colour c has a box
  std::vector<std::uint64_t> any_, masks_;
  std::array<RegionBuilder, kMaxColours> builders_;
  std::vector<Region> regions_;
};

}  // namespace sidestep
