// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/camera/camera_model.hpp"
#include "common/geometry/box.hpp"
#include "common/geometry/field.hpp"
#include "common/geometry/field_marking.hpp"
#include "common/random/rng.hpp"
#include "simulator/rendering/canvas.hpp"
#include "simulator/rendering/render_spec.hpp"

namespace sidestep {

/// The white lines of a field, including the centre circle, as defined by FieldMarking.
class FieldLines {
 public:
  explicit FieldLines(const Field& field);
  /// Distance from a point to the edge of the nearest line, negative on a line.
  double distance_m(const Vec2& p) const;

 private:
  FieldMarking marking_;
  std::array<Box, std::tuple_size_v<decltype(FieldMarking::lines)>> lines_;  ///< lines without width
};

/// The fraction of full light at a point of the floor. Beyond the field's far end, the light is the same as
/// at the far end.
double light_fraction_at(const RenderSpec& spec, const Field& field, const Vec2& p);

/// A camera's view of the empty floor under neutral light: the field surface with its lines, its texture and
/// a margin around the field, and a dark floor beyond.
Canvas render_floor(const CameraModel& camera, const Field& field, const RenderSpec& spec, Rng& rng);

}  // namespace sidestep
