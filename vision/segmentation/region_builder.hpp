// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vision/segmentation/region.hpp"

namespace sidestep {

/// Puts the runs of one colour together to regions, row by row: a run belongs to the regions of the row above
/// that it touches, corners included, and union-find makes one of them (CMVision; Bruce, appendix A.2). Keeps
/// two rows of runs and sums for each region. Allocates when a frame has more runs in a row, or more regions,
/// than any before.
class RegionBuilder {
 public:
  /// A frame with more regions than this in one colour is noise: what begins then is left out and counted.
  static constexpr std::size_t kMaxRegions = 1 << 16;

  void begin_frame();
  /// Pixels begin .. end - 1 of the current row, in ascending order.
  void add_run(int begin_px, int end_px) {
    if (!row_.empty() && row_.back().end_px == begin_px) {
      row_.back().end_px = end_px;
    } else {
      row_.push_back({begin_px, end_px, 0});
    }
  }
  /// Every row is to be ended in which, or in the row above which, there are runs.
  bool has_runs() const { return !row_.empty() || !row_above_.empty(); }
  void end_row(int y_px);
  /// Appends the regions of at least so many pixels.
  void finish(std::uint32_t colour, std::uint32_t least_area_px, std::vector<Region>& regions);
  std::uint64_t left_out() const { return left_out_; }

 private:
  struct Run {
    int begin_px, end_px;
    std::uint32_t region;
  };
  struct Sums {
    std::uint32_t parent;  ///< itself, if nobody
    std::uint32_t area_px = 0;
    std::uint64_t x_px = 0, y_px = 0;
    int left_px, right_px, top_px, bottom_px;
  };

  std::uint32_t root_of(std::uint32_t region);
  std::uint32_t region_for(const Run& run, std::size_t& above);
  std::uint32_t united(std::uint32_t a, std::uint32_t b);
  void add(const Run& run, int y_px);

  std::vector<Run> row_, row_above_;
  std::vector<Sums> regions_;
  std::uint64_t left_out_ = 0;
};

}  // namespace sidestep
