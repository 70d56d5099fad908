// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/marking/butterfly.hpp"
#include "tests/study/camera/camera_floor.hpp"
#include "tests/study/camera/pixel_guide.hpp"

namespace sidestep {

/// The first image of a random floor, and a guide that has processed it.
class FirstView {
 public:
  explicit FirstView(std::uint64_t seed)
      : rng_(seed), floor_(sample_camera_floor(rng_)), guide_(guiding_camera(), kGuidedField, {}) {
    FrameRenderer renderer(guiding_camera(), kGuidedField, butterfly(), RenderSpec{}, Rng(rng_.bits()),
                           floor_.statics);
    SceneRobot robot;
    robot.position_m = floor_.start_m;
    const SceneBall ball{{floor_.target_m.x(), floor_.target_m.y(), RollingBall::kRadius_m}, {0, 0}};
    image_ = renderer.render({{&robot, 1}, floor_.cylinders, ball});
    guidance_ = guide_.guide(image_.view());
  }

  const CameraFloor& floor() const { return floor_; }
  const Image& image() const { return image_; }
  PixelGuide& guide() { return guide_; }
  const PixelGuide::Guidance& guidance() const { return guidance_; }
  Rng& rng() { return rng_; }

 private:
  Rng rng_;
  CameraFloor floor_;
  PixelGuide guide_;
  Image image_;
  PixelGuide::Guidance guidance_;
};

}  // namespace sidestep
