// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/geometry/field.hpp"
#include "common/image/image.hpp"
#include "common/marking/layout.hpp"
#include "common/random/rng.hpp"
#include "simulator/rendering/canvas.hpp"
#include "simulator/rendering/render_spec.hpp"
#include "simulator/rendering/scene.hpp"
#include "simulator/rendering/sensor_noise.hpp"
#include "simulator/rendering/static_obstacles.hpp"
#include "simulator/rendering/vertical_body.hpp"

namespace sidestep {

/// Renders the frames of one camera. The floor with its static obstacles is drawn, blurred and converted
/// once; a frame then costs only drawing its objects, plus one pass over its bytes to add the noise.
class FrameRenderer {
 public:
  /// The state of `rng` determines the frames. Throws std::invalid_argument if the width is odd with kYuv422.
  FrameRenderer(const CameraModel& camera, const Field& field, const MarkerLayout& layout,
                const RenderSpec& spec, Rng rng, const StaticScene& statics = {});

  /// Renders a frame in the spec's format and the camera's size. Precondition: `pixels` has space for
  /// ImageView::bytes() bytes.
  void render(const Scene& scene, std::uint8_t* pixels);
  /// Renders a frame into a new image.
  Image render(const Scene& scene);

  const CameraModel& camera() const { return camera_; }

 private:
  /// An object of the scene. Objects are drawn starting with the farthest from the camera.
  struct VisibleObject {
    double distance_m;
    Vec2 place_m;
    enum class Kind { kRobot, kCylinder, kBall } kind;
    std::size_t index;
  };

  void render_floor_once(const StaticScene& statics);
  void sort_objects(const Scene& scene);
  cv::Rect draw_object(const Scene& scene, const VisibleObject& object);
  /// Draws an object except for the parts hidden by static obstacles.
  cv::Rect draw_visible_part(const Scene& scene, const VisibleObject& object);
  cv::Rect draw_robot(const SceneRobot& robot);
  cv::Rect draw_cylinder(const SceneCylinder& cylinder);
  Eigen::Vector3d gain_at(const Vec2& p) const;
  /// Applies the lens blur to this part of the canvas and converts the result into the clean frame.
  void blur(const cv::Rect& rect);
  void restore(const cv::Rect& rect);
  std::size_t row_bytes() const { return ImageView{spec_.format, canvas_.cols, 1}.row_bytes(); }

  CameraModel camera_;
  Field field_;
  MarkerLayout layout_;
  RenderSpec spec_;
  Rng rng_;
  SensorNoise noise_;
  StaticOcclusion cover_;
  Canvas floor_;                           ///< the floor with static obstacles, under the actual light
  Canvas canvas_;                          ///< the floor with the objects drawn so far
  int blur_size_ = 1;                      ///< size of the kernel, odd
  std::vector<std::uint8_t> clean_floor_;  ///< the converted frame of floor_, without noise
  std::vector<std::uint8_t> clean_;        ///< the converted frame of canvas_, without noise
  std::vector<VisibleObject> objects_;
  std::vector<cv::Rect> changed_;
  Canvas before_;  ///< the canvas before an object is drawn
  std::vector<TopDot> dots_;
};

}  // namespace sidestep
