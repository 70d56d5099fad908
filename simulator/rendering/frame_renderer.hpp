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
#include "simulator/rendering/vertical_body.hpp"

namespace sidestep {

/// The frames of one camera. The empty floor is drawn, blurred and written down once; a frame costs what
/// moves on it, and one pass over its bytes for the noise.
class FrameRenderer {
 public:
  /// The same generator gives the same frames. Throws std::invalid_argument for a width that is odd with
  /// kYuv422.
  FrameRenderer(const CameraModel& camera, const Field& field, const MarkingLayout& layout,
                const RenderSpec& spec, Rng rng);

  /// Renders a frame of the camera's size into spec().format's bytes; `pixels` has room for
  /// ImageView::bytes().
  void render(const Scene& scene, std::uint8_t* pixels);
  /// The same into an image of its own.
  Image render(const Scene& scene);

  /// Changes the light's colour from the next frame on; costs about as much as several frames.
  void set_colour_gain(const Eigen::Vector3d& gain);

  const CameraModel& camera() const { return camera_; }
  const RenderSpec& spec() const { return spec_; }

 private:
  /// Something of the scene, the farthest from the camera first.
  struct Sight {
    double distance_m;
    enum class Kind { kRobot, kBlob, kBall } kind;
    std::size_t index;
  };

  void find_sights(const Scene& scene);
  cv::Rect draw_sight(const Scene& scene, const Sight& sight);
  cv::Rect draw_robot(const SceneRobot& robot);
  cv::Rect draw_blob(const SceneBlob& blob);
  Eigen::Vector3d gain_at(const Vec2& p) const;
  /// What the lens makes of the canvas goes into the clean frame.
  void blur(const cv::Rect& rect);
  void restore(const cv::Rect& rect);
  std::size_t row_bytes() const { return ImageView{spec_.format, canvas_.cols, 1}.row_bytes(); }

  CameraModel camera_;
  Field field_;
  MarkingLayout layout_;
  RenderSpec spec_;
  Rng rng_;
  SensorNoise noise_;
  Canvas grey_floor_;                      ///< the empty floor under light without a colour
  Canvas floor_;                           ///< and under the light as it is
  Canvas canvas_;                          ///< the floor, with what is being drawn on it
  int blur_size_ = 1;                      ///< of the kernel, odd
  std::vector<std::uint8_t> clean_floor_;  ///< the frame of the empty floor without noise
  std::vector<std::uint8_t> clean_;        ///< the same with what stands on it
  std::vector<Sight> sights_;
  std::vector<cv::Rect> changed_;
  std::vector<TopDot> dots_;
};

}  // namespace sidestep
