// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "vision/segmentation/region.hpp"

namespace sidestep {

/// Merges regions of one colour that are close and together fill their common bounding box well. These are
/// parts of one patch that noise or a line has split (CMVision; Bruce, CMU-CS-06-181, appendix A.1). Each
/// region absorbs regions that start farther down. Precondition: regions are grouped by colour, ascending by
/// top_px; the order is preserved. `max_gap_px` is the maximum gap in columns or rows between the bounding
/// boxes of merged regions; negative: no merging.
void merge_by_density(std::vector<Region>& regions, int max_gap_px);

}  // namespace sidestep
