// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/round_ball.hpp"

#include <cmath>

#include "simulator/rendering/coverage/sample_pattern.hpp"
#include "simulator/rendering/footprint.hpp"

namespace sidestep {
namespace {

/// A camera's view of a ball: the viewing rays that pass its centre within its radius.
class BallView {
 public:
  BallView(const SceneBall& ball, const CameraModel& camera, const Eigen::Matrix2d& metres_per_pixel,
           double exposure_s)
      : centre_m_(ball.position_m), camera_m_(camera.position_m()) {
    const Vec2 motion_m = ball.velocity_mps * exposure_s;
    reach_m_ = pixel_reach_m(metres_per_pixel) + motion_m.norm() / 2;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const Vec2 offset = metres_per_pixel * Vec2(kSamplePattern.x[i], kSamplePattern.y[i]) -
                          motion_m * kSamplePattern.time[i];
      offsets_x_[i] = static_cast<float>(offset.x());
      offsets_y_[i] = static_cast<float>(offset.y());
    }
  }

  /// The fraction of a pixel that shows the ball. The viewing ray of the pixel's centre meets the horizontal
  /// plane through the ball's centre at place_m.
  float share(const Vec2& place_m) const {
    const Vec2 offset_m = place_m - centre_m_.head<2>();
    const Vec2 ray = (Vec3(place_m.x(), place_m.y(), centre_m_.z()) - camera_m_).normalized().head<2>();
    const double distance_m =
        std::sqrt(std::max(0.0, offset_m.squaredNorm() - std::pow(offset_m.dot(ray), 2)));
    if (distance_m - kBallRadius_m > reach_m_) return 0;
    if (kBallRadius_m - distance_m > reach_m_) return 1;
    const float x = static_cast<float>(offset_m.x()), y = static_cast<float>(offset_m.y());
    const float ray_x = static_cast<float>(ray.x()), ray_y = static_cast<float>(ray.y());
    const float square = static_cast<float>(kBallRadius_m * kBallRadius_m);
    int count = 0;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const float dx = x + offsets_x_[i], dy = y + offsets_y_[i], a = dx * ray_x + dy * ray_y;
      count += dx * dx + dy * dy - a * a <= square ? 1 : 0;
    }
    return static_cast<float>(count) / static_cast<float>(kSamples);
  }

 private:
  Vec3 centre_m_, camera_m_;
  double reach_m_ = 0;
  SampleAxis offsets_x_{}, offsets_y_{};
};

}  // namespace

cv::Rect draw(const SceneBall& ball, const Light& light, const CameraModel& camera, double exposure_s,
              Canvas& canvas) {
  const Vec3& centre_m = ball.position_m;
  const double motion_m = ball.velocity_mps.norm() * exposure_s / 2;
  const auto rect = footprint(camera, centre_m.head<2>(), kBallRadius_m + motion_m,
                              centre_m.z() - kBallRadius_m, centre_m.z() + kBallRadius_m);
  if (rect.empty()) return {};
  const auto slope = camera.projection_jacobian(centre_m);
  if (!slope) return {};
  const BallView view(ball, camera, slope->leftCols<2>().inverse(), exposure_s);
  for (int y = rect.y; y < rect.br().y; ++y) {
    cv::Vec3b* const row = canvas[y];
    for (int x = rect.x; x < rect.br().x; ++x) {
      const auto place_m = camera.point_at(Vec2(x, y), centre_m.z());
      const float share = place_m ? view.share(*place_m) : 0;
      if (share > 0) row[x] = bytes_of(share * light + (1 - share) * light_of(row[x]));
    }
  }
  return rect;
}

}  // namespace sidestep
