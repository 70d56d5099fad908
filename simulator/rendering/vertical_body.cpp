// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/vertical_body.hpp"

#include <algorithm>
#include <cmath>

#include "simulator/rendering/counting/kernels.hpp"
#include "simulator/rendering/footprint.hpp"

namespace sidestep {
namespace {

constexpr int kLargestSquare = 16;
constexpr float kAll = static_cast<float>(kSamples);

/// How far any point of a body gets from where it is at the time of capture, while the shutter is open.
double motion_reach_m(const VerticalBody& body, double exposure_s) {
  return (body.velocity_mps.norm() + std::abs(body.angular_radps) * body.radius_m) * exposure_s / 2;
}

/// A body as one camera sees it. A pixel's ray meets the plane of the top at p and the floor at p + lean (p -
/// foot): the pixel shows the body where this line meets the outline, and the top where p lies in it.
class SeenBody {
 public:
  SeenBody(const VerticalBody& body, const CameraModel& camera, const Eigen::Matrix2d& metres_per_pixel,
           double exposure_s)
      : body_(body), position_m_(body.position_m), heading_(Eigen::Rotation2Dd(-body.heading_rad)) {
    const double camera_m = camera.position_m().z();
    lean_ = body.height_m / (camera_m - body.height_m);
    foot_m_ = heading_ * (camera.position_m().head<2>() - position_m_);
    outline_ = {float(body.radius_m), float(body.front_m)};
    lines_ = {float(lean_), float(foot_m_.x()), float(foot_m_.y())};
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

  /// What all pixels of a square show.
  struct Look {
    bool is_mixed;       ///< not all of them the same, or not for sure
    const Light* light;  ///< nothing: what was there before
  };

  /// Of a square of so many pixels a side, whose centre's ray meets the top's plane at a place.
  Look look(const Vec2& place_m, int size) const {
    const Vec2 p = in_frame(place_m);
    const double reach_m = reach_of(size), body_reach_m = line_reach_m(reach_m), body_m = body_distance_m(p);
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

  /// Paints a pixel by the shares that its samples find.
  void paint(const Vec2& place_m, cv::Vec3b& pixel) const {
    const Vec2 p = in_frame(place_m);
    Points moved;
    counting::Pixel pixel_points{static_cast<float>(p.x()), static_cast<float>(p.y()), &offsets_};
    if (motion_m_ > 0) {
      move(pixel_points, moved);
      pixel_points.about = &moved;
    }
    const double reach_m = reach_of(1);
    // How many of them lie within something whose edge is so far from the pixel's centre.
    const auto count = [](double distance_m, double least_m, auto count_samples) {
      return distance_m > least_m ? 0.0F : distance_m < -least_m ? kAll : static_cast<float>(count_samples());
    };
    const float on_body = count(body_distance_m(p), line_reach_m(reach_m),
                                [&] { return kernels_.on_lines(offsets_, pixel_points, lines_, outline_); });
    const float on_top =
        count(top_distance_m(p), reach_m, [&] { return kernels_.in_outline(pixel_points, outline_); });
    const float on_side = std::max(0.0F, on_body - on_top);
    Light light = on_side * body_.side + on_top * body_.top;
    for (const TopDot& dot : body_.dots) {
      const double dot_m = (p - dot.position_m).norm() - dot.radius_m;
      const float on_dot = count(dot_m, reach_m, [&] {
        return kernels_.in_disc(pixel_points, float(dot.position_m.x()), float(dot.position_m.y()),
                                float(dot.radius_m));
      });
      if (on_dot > 0) light += on_dot * (dot.light - body_.top);
    }
    light += (kAll - on_side - on_top) * light_of(pixel);
    pixel = bytes_of(light / kAll);
  }

 private:
  Vec2 in_frame(const Vec2& place_m) const { return heading_ * (place_m - position_m_); }

  /// No edge farther than this from its centre crosses a square.
  double reach_of(int size) const { return size * pixel_reach_m_ + motion_m_; }
  /// The same for edges that the line from top to floor draws: its far end moves more than its near one.
  double line_reach_m(double reach_m) const { return 1.2 * (1 + lean_) * reach_m; }

  double top_distance_m(const Vec2& p) const {
    return std::max(p.norm() - body_.radius_m, p.x() - body_.front_m);
  }

  /// How far inside the body's outline in the image a point is, negative, or outside; in metres at its top,
  /// and rather too near to the edge than too far.
  double body_distance_m(const Vec2& p) const {
    const Vec2 line = lean_ * (p - foot_m_), end = p + line;
    const double square = line.squaredNorm();
    const Vec2 nearest = p + (square > 0 ? std::clamp(-p.dot(line) / square, 0.0, 1.0) : 0.0) * line;
    // Any point of the line is as deep in the image as it is in the body.
    const double inside_m = std::min({top_distance_m(p), top_distance_m(end), top_distance_m(nearest)});
    if (inside_m < 0) return inside_m;
    const double ahead_m = std::min(p.x(), end.x()) - body_.front_m;
    return std::max({0.0, nearest.norm() - body_.radius_m, ahead_m});
  }

  /// To where a pixel's points were in the body's frame at their instants of the exposure.
  void move(const counting::Pixel& pixel, Points& moved) const {
    for (std::size_t i = 0; i < kSamples; ++i) {
      const float x = offsets_.x[i] + shifts_.x[i], y = offsets_.y[i] + shifts_.y[i];
      const float turn = turn_ * kSamplePattern.time[i];
      moved.x[i] = x + turn * (y + pixel.y);
      moved.y[i] = y - turn * (x + pixel.x);
    }
  }

  const VerticalBody& body_;
  Vec2 position_m_;
  Eigen::Matrix2d heading_;  ///< from the world to the body's frame
  Vec2 foot_m_;              ///< of the camera, in the body's frame
  double lean_ = 0;
  double pixel_reach_m_ = 0;
  double motion_m_ = 0;
  float turn_ = 0;
  const counting::Kernels& kernels_ = counting::best_kernels();
  counting::TrajectoryBounds outline_;
  counting::Lines lines_;
  Points offsets_, shifts_;
};

/// Paints what a body shows in squares of pixels: whole where they show one thing, else in quarters.
class Painter {
 public:
  Painter(const SeenBody& body, const CameraModel& camera, double height_m, const cv::Rect& rect,
          Canvas& canvas)
      : body_(body), camera_(camera), height_m_(height_m), rect_(rect), canvas_(canvas) {}

  /// A square of pixels, of a power of two a side; its part in the rectangle.
  void paint(int x, int y, int size) {
    if (x >= rect_.br().x || y >= rect_.br().y) return;
    const double half = (size - 1) / 2.0;
    const auto place_m = camera_.point_at(Vec2(x + half, y + half), height_m_);
    const SeenBody::Look look = place_m ? body_.look(*place_m, size) : SeenBody::Look{size > 1, nullptr};
    if (!look.is_mixed) {
      if (look.light) fill(cv::Rect(x, y, size, size) & rect_, bytes_of(*look.light));
      return;
    }
    if (size == 1) {
      body_.paint(*place_m, canvas_(y, x));
      return;
    }
    const int part = size / 2;
    for (const int dy : {0, part})
      for (const int dx : {0, part}) paint(x + dx, y + dy, part);
  }

 private:
  void fill(const cv::Rect& rect, const cv::Vec3b& colour) {
    for (int y = rect.y; y < rect.br().y; ++y) std::fill_n(canvas_[y] + rect.x, rect.width, colour);
  }

  const SeenBody& body_;
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
  const auto slope = camera.pixels_per_metre(Vec3(body.position_m.x(), body.position_m.y(), body.height_m));
  if (!slope) return {};
  const SeenBody seen(body, camera, slope->leftCols<2>().inverse(), exposure_s);
  Painter painter(seen, camera, body.height_m, rect, canvas);
  for (int y = rect.y; y < rect.br().y; y += kLargestSquare)
    for (int x = rect.x; x < rect.br().x; x += kLargestSquare) painter.paint(x, y, kLargestSquare);
  return rect;
}

}  // namespace sidestep
