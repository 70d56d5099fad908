// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "vision/segmentation/region.hpp"

namespace sidestep {

struct MergeSettings {
  double min_density = 0.5;  ///< minimum fraction of the common bounding box that both regions fill together
  /// Maximum gap in columns or rows between their bounding boxes; negative: no merging.
  int max_gap_px = 2;
};

/// Merges regions of one colour that are close and together fill their common bounding box well. These are
/// parts of one patch that noise or a line has split (CMVision; Bruce, CMU-CS-06-181, appendix A.1). Each
/// region absorbs regions that start farther down. Precondition: regions are grouped by colour, ascending by
/// top_px; the order is preserved.
void merge_by_density(std::vector<Region>& regions, const MergeSettings& settings);

}  // namespace sidestep
