// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/box.hpp"
#include "deploy/audit/metrics/floor_trace.hpp"

namespace sidestep {

/// The field as a box.
[[nodiscard]] Box field_box(const Field& field);

/// The part of the field that a picture shows: what robots and opponents used, with a margin, and the
/// obstacles there. A part that is little smaller than the field is extended to the field's edges.
[[nodiscard]] Box shown_part(const FloorTrace& trace);

}  // namespace sidestep
