// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/camera_model.hpp"
#include "common/geometry/field.hpp"
#include "simulator/field_marking.hpp"
#include "common/random/rng.hpp"
#include "simulator/rendering/canvas.hpp"
#include "simulator/rendering/render_spec.hpp"

namespace sidestep {

/// The white lines of the league's field, scaled to this one.
class FieldLines {
 public:
  explicit FieldLines(const Field& field) : field_(field), marking_(field) {}
  /// From a point to the next line's edge, negative on a line.
  double distance_m(const Vec2& p) const;

 private:
  Field field_;
  FieldMarking marking_;
};

/// The share of the full light at a place of the floor; never less than the far end's.
double light_at(const RenderSpec& spec, const Field& field, const Vec2& p);

/// What the camera sees of an empty floor under light without a colour: carpet with lines and texture, a
/// margin of carpet round the field, and a dark floor beyond.
Canvas sample_floor(const CameraModel& camera, const Field& field, const RenderSpec& spec, Rng& rng);

}  // namespace sidestep
