// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/collision/shapes.hpp"
#include "common/geometry/field.hpp"
#include "common/map/floor_map.hpp"
#include "simulator/rendering/canvas.hpp"
#include "simulator/rendering/render_spec.hpp"

namespace sidestep {

/// Obstacles that never move: prisms that stand on the floor, as high as the robots.
struct StaticScene {
  std::vector<Shape> shapes;
  std::shared_ptr<const FloorMap> map;  ///< its blocked cells and its outside are obstacles; null: no map
  double height_m = 0.15;
  Rgb colour{128, 125, 120};  ///< grey that no marker, ball or person shows

  bool empty() const { return shapes.empty() && !map; }
};

/// Segments have no thickness, so they are drawn as boards that extend this far to every side.
inline constexpr double kBoardHalfThickness_m = 0.005;

/// The regions that static obstacles hide from one camera.
struct StaticOcclusion {
  cv::Mat1b samples;  ///< number of samples per pixel, of kSamples, that show an obstacle
  /// The distance from the point below the camera to the point where the pixel's viewing ray meets an
  /// obstacle. Anything farther along the ray is hidden. Meaningful where `samples` is not 0.
  cv::Mat1f front_m;
};

/// Draws the obstacles over a floor under neutral light, antialiased, and returns the regions that they hide:
/// empty matrices if there are no obstacles. Draws nothing unless the camera is above the obstacles.
StaticOcclusion draw_static(const StaticScene& scene, const CameraModel& camera, const Field& field,
                            const RenderSpec& spec, Canvas& floor);

/// Removes the parts of an object that static obstacles hide, after the object was drawn over them within a
/// rectangle. `before` contains the rectangle's pixels without the object.
void remove_hidden_parts(const StaticOcclusion& cover, const CameraModel& camera, const Vec2& object_m,
                         const cv::Rect& rect, const Canvas& before, Canvas& canvas);

}  // namespace sidestep
