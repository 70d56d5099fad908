// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/vertical_body.hpp"

#include <algorithm>
#include <cmath>

#include "simulator/rendering/coverage/kernels.hpp"
#include "simulator/rendering/footprint.hpp"

namespace sidestep {
namespace {

constexpr int kMaxSquare_px = 16;
constexpr float kAllSamples = static_cast<float>(kSamples);

/// The maximum distance, during the exposure, of any point of a body from its position at the time of
/// capture.
double motion_reach_m(const VerticalBody& body, double exposure_s) {
  return (body.velocity_mps.norm() + std::abs(body.angular_radps) * body.radius_m) * exposure_s / 2;
}

/// A camera's view of a body. A viewing ray that meets the plane of the top at p meets the floor at p +
/// parallax (p - nadir). The ray shows the body if its projection between these two points meets the
/// cross-section, and the top if p lies in the cross-section.
class BodyView {
 public:
  BodyView(const VerticalBody& body, const CameraModel& camera, const Eigen::Matrix2d& metres_per_pixel,
           double exposure_s)
      : body_(body), position_m_(body.position_m), heading_(Eigen::Rotation2Dd(-body.heading_rad)) {
    const double camera_m = camera.position_m().z();
    parallax_ = body.height_m / (camera_m - body.height_m);
    nadir_m_ = heading_ * (camera.position_m().head<2>() - position_m_);
    section_ = {float(body.radius_m), float(body.front_m)};
    rays_ = {float(parallax_), float(nadir_m_.x()), float(nadir_m_.y())};
    const Eigen::Matrix2f by_pixel = (heading_ * metres_per_pixel).cast<float>();
    const Eigen::Vector2f by_time = (heading_ * body.velocity_mps * exposure_s).cast<float>();
    turn_ = static_cast<float>(body.angular_radps * exposure_s);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const float x = kSamplePattern.x[i], y = kSamplePattern.y[i], t = kSamplePattern.time[i];
      offsets_.x[i] = by_pixel(0, 0) * x + by_pixel(0, 1) * y;
      offsets_.y[i] = by_pixel(1, 0) * x + by_pixel(1, 1) * y;
      shifts_.x[i] = -by_time.x() * t;
      shifts_.y[i] = -by_time.y() * t;
    }
    pixel_reach_m_ = pixel_reach_m(metres_per_pixel);
    motion_m_ = motion_reach_m(body, exposure_s);
  }

  /// The content of a square of pixels.
  struct SquareContent {
    bool is_mixed;       ///< the pixels may differ in colour
    const Light* light;  ///< colour of all pixels; null: the background
  };

  /// The content of a square of size x size pixels. The viewing ray of its centre meets the plane of the top
  /// at place_m.
  SquareContent content_of(const Vec2& place_m, int size) const {
    const Vec2 p = in_frame(place_m);
    const double reach_m = reach_of(size), body_reach_m = ray_reach_m(reach_m), body_m = body_distance_m(p);
    if (body_m > body_reach_m) return {false, nullptr};
    const double top_m = top_distance_m(p);
    if (std::abs(top_m) <= reach_m || body_m >= -body_reach_m) return {true, nullptr};
    if (top_m > 0) return {false, &body_.side};
    const Light* light = &body_.top;
    for (const TopDot& dot : body_.dots) {
      const double dot_m = (p - dot.position_m).norm() - dot.radius_m;
      if (std::abs(dot_m) <= reach_m) return {true, nullptr};
      if (dot_m < 0) light = &dot.light;
    }
    return {false, light};
  }

  /// Paints a pixel according to the counts of its samples.
  void paint(const Vec2& place_m, cv::Vec3b& pixel) const {
    const Vec2 p = in_frame(place_m);
    Points moved{};
    coverage::PixelSamples samples{static_cast<float>(p.x()), static_cast<float>(p.y()), &offsets_};
    if (motion_m_ > 0) {
      move(samples, moved);
      samples.offsets = &moved;
    }
    const double reach_m = reach_of(1);
    // Returns the number of samples inside a shape at this signed distance from the pixel's centre. Counts
    // them one by one only if the shape's edge is within `max_m` of the centre.
    const auto count = [](double distance_m, double max_m, auto count_samples) {
      return distance_m > max_m    ? 0.0F
             : distance_m < -max_m ? kAllSamples
                                   : static_cast<float>(count_samples());
    };
    const float on_body = count(body_distance_m(p), ray_reach_m(reach_m), [&] {
      return kernels_.count_rays_hitting(offsets_, samples, rays_, section_);
    });
    const float on_top =
        count(top_distance_m(p), reach_m, [&] { return kernels_.count_in_cross_section(samples, section_); });
    const float on_side = std::max(0.0F, on_body - on_top);
    Light light = on_side * body_.side + on_top * body_.top;
    for (const TopDot& dot : body_.dots) {
      const double dot_m = (p - dot.position_m).norm() - dot.radius_m;
      const float on_dot = count(dot_m, reach_m, [&] {
        return kernels_.count_in_disc(samples, float(dot.position_m.x()), float(dot.position_m.y()),
                                      float(dot.radius_m));
      });
      if (on_dot > 0) light += on_dot * (dot.light - body_.top);
    }
    light += (kAllSamples - on_side - on_top) * light_of(pixel);
    pixel = bytes_of(light / kAllSamples);
  }

 private:
  Vec2 in_frame(const Vec2& place_m) const { return heading_ * (place_m - position_m_); }

  /// Maximum distance from a square's centre to an edge that crosses the square.
  double reach_of(int size) const { return size * pixel_reach_m_ + motion_m_; }
  /// Like reach_of(), for the body's silhouette: the far end of a viewing ray moves more than its near end.
  double ray_reach_m(double reach_m) const { return 1.2 * (1 + parallax_) * reach_m; }

  double top_distance_m(const Vec2& p) const {
    return std::max(p.norm() - body_.radius_m, p.x() - body_.front_m);
  }

  /// Signed distance from the body's silhouette, negative inside, in metres at the height of the top. Its
  /// magnitude never exceeds the true distance.
  double body_distance_m(const Vec2& p) const {
    const Vec2 ray = parallax_ * (p - nadir_m_), end = p + ray;
    const double square = ray.squaredNorm();
    const Vec2 nearest = p + (square > 0 ? std::clamp(-p.dot(ray) / square, 0.0, 1.0) : 0.0) * ray;
    // If a point of the ray is this deep inside the cross-section, p is at least as deep inside the
    // silhouette.
    const double inside_m = std::min({top_distance_m(p), top_distance_m(end), top_distance_m(nearest)});
    if (inside_m < 0) return inside_m;
    const double ahead_m = std::min(p.x(), end.x()) - body_.front_m;
    return std::max({0.0, nearest.norm() - body_.radius_m, ahead_m});
  }

  /// Transforms a pixel's samples to the body's frame at their times within the exposure.
  void move(const coverage::PixelSamples& samples, Points& moved) const {
    for (std::size_t i = 0; i < kSamples; ++i) {
      const float x = offsets_.x[i] + shifts_.x[i], y = offsets_.y[i] + shifts_.y[i];
      const float turn = turn_ * kSamplePattern.time[i];
      moved.x[i] = x + turn * (y + samples.y);
      moved.y[i] = y - turn * (x + samples.x);
    }
  }

  const VerticalBody& body_;
  Vec2 position_m_;
  Eigen::Matrix2d heading_;  ///< rotation from the world to the body's frame
  Vec2 nadir_m_;             ///< nadir of the camera, in the body's frame
  double parallax_ = 0;
  double pixel_reach_m_ = 0;
  double motion_m_ = 0;
  float turn_ = 0;
  const coverage::Kernels& kernels_ = coverage::best_kernels();
  coverage::CrossSection section_;
  coverage::ViewingRays rays_;
  Points offsets_{}, shifts_{};
};

/// Paints a body square by square. Squares are divided into quarters until all pixels of each are equal.
class Painter {
 public:
  Painter(const BodyView& body, const CameraModel& camera, double height_m, const cv::Rect& rect,
          Canvas& canvas)
      : body_(body), camera_(camera), height_m_(height_m), rect_(rect), canvas_(canvas) {}

  /// Paints the part of a square that lies in the rectangle. The side of the square is a power of two.
  void paint(int x, int y, int size) {
    if (x >= rect_.br().x || y >= rect_.br().y) return;
    const double half = (size - 1) / 2.0;
    const auto place_m = camera_.point_at(Vec2(x + half, y + half), height_m_);
    const BodyView::SquareContent content =
        place_m ? body_.content_of(*place_m, size) : BodyView::SquareContent{size > 1, nullptr};
    if (!content.is_mixed) {
      if (content.light) fill(cv::Rect(x, y, size, size) & rect_, bytes_of(*content.light));
      return;
    }
    if (size == 1) {
      body_.paint(*place_m, canvas_(y, x));
      return;
    }
    const int half_size = size / 2;
    for (const int dy : {0, half_size})
      for (const int dx : {0, half_size}) paint(x + dx, y + dy, half_size);
  }

 private:
  void fill(const cv::Rect& rect, const cv::Vec3b& colour) {
    for (int y = rect.y; y < rect.br().y; ++y) std::fill_n(canvas_[y] + rect.x, rect.width, colour);
  }

  const BodyView& body_;
  const CameraModel& camera_;
  double height_m_;
  cv::Rect rect_;
  Canvas& canvas_;
};

}  // namespace

cv::Rect draw(const VerticalBody& body, const CameraModel& camera, double exposure_s, Canvas& canvas) {
  const double reach_m = body.radius_m + motion_reach_m(body, exposure_s);
  const auto rect = footprint(camera, body.position_m, reach_m, 0, body.height_m);
  if (rect.empty()) return {};
  const auto slope =
      camera.projection_jacobian(Vec3(body.position_m.x(), body.position_m.y(), body.height_m));
  if (!slope) return {};
  const BodyView view(body, camera, slope->leftCols<2>().inverse(), exposure_s);
  Painter painter(view, camera, body.height_m, rect, canvas);
  for (int y = rect.y; y < rect.br().y; y += kMaxSquare_px)
    for (int x = rect.x; x < rect.br().x; x += kMaxSquare_px) painter.paint(x, y, kMaxSquare_px);
  return rect;
}

}  // namespace sidestep
