// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vision/segmentation/region.hpp"

namespace sidestep {

/// Joins the runs of one colour to regions, row by row: a run belongs to the regions of all runs in the row
/// above that it touches, including at corners, and union-find merges these regions (CMVision; Bruce,
/// CMU-CS-06-181, appendix A.1). Stores two rows of runs, and sums for each region. Allocates only if a frame
/// has more regions, or more runs in a row, than all earlier frames.
class RegionBuilder {
 public:
  /// A frame with more regions of one colour than this is noise: further regions are dropped.
  static constexpr std::size_t kMaxRegions = 1 << 16;

  void begin_frame();
  /// Adds pixels begin .. end - 1 of the current row, in ascending order.
  void add_run(int begin_px, int end_px) {
    if (!row_.empty() && row_.back().end_px == begin_px) {
      row_.back().end_px = end_px;
    } else {
      row_.push_back({begin_px, end_px, 0});
    }
  }
  /// Whether the current row or the row above has runs; if so, the row must be ended.
  bool has_runs() const { return !row_.empty() || !row_above_.empty(); }
  void end_row(int y_px);
  /// Appends the regions of at least `min_area_px` pixels.
  void finish(std::uint32_t colour, std::uint32_t min_area_px, std::vector<Region>& regions);

 private:
  struct Run {
    int begin_px, end_px;
    std::uint32_t region;
  };
  struct Sums {
    std::uint32_t parent = 0;  ///< a root's parent is itself
    std::uint32_t area_px = 0;
    std::uint64_t x_px = 0, y_px = 0;
    int left_px = 0, right_px = 0, top_px = 0, bottom_px = 0;
  };

  std::uint32_t root_of(std::uint32_t region);
  std::uint32_t region_for(const Run& run, std::size_t& above);
  std::uint32_t united(std::uint32_t a, std::uint32_t b);
  void add(const Run& run, int y_px);

  std::vector<Run> row_, row_above_;
  std::vector<Sums> regions_;
};

}  // namespace sidestep
