// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "vision/segmentation/region.hpp"

namespace sidestep {

struct MergeSettings {
  double least_density = 0.5;  ///< share of the common bounding box that both together fill
  int most_gap_px = 2;         ///< columns or rows between their bounding boxes; below 0: nothing is merged
};

/// Makes one region of two of a colour that lie close and together fill their bounding box well: a patch that
/// noise or a line has torn apart (CMVision; Bruce, appendix A.2). Each takes what it can of those that begin
/// farther down. Precondition: regions of a colour stand side by side, ascending by top_px; they stay so.
void merge_by_density(std::vector<Region>& regions, const MergeSettings& settings);

}  // namespace sidestep
