// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/frame_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "common/image/pixel_conversion.hpp"
#include "simulator/rendering/field_surface.hpp"
#include "simulator/rendering/round_ball.hpp"

namespace sidestep {
namespace {

constexpr Rgb kRobotSide{34, 34, 37};
constexpr double kCylinderSideBrightness = 0.55;  // relative to the top
constexpr double kMinBlur_px = 0.2;

const CameraModel& checked(const CameraModel& camera, const RenderSpec& spec) {
  if (spec.format == PixelFormat::kYuv422 && camera.parameters().width_px % 2 != 0)
    throw std::invalid_argument("image width: expected an even number for YUV 4:2:2, got " +
                                std::to_string(camera.parameters().width_px));
  return camera;
}

/// Expands to whole pairs of pixels, which share a chroma sample in YUV 4:2:2.
cv::Rect aligned_to_pairs(const cv::Rect& rect) {
  const int left = rect.x & ~1, right = (rect.br().x + 1) & ~1;
  return {left, rect.y, right - left, rect.height};
}

cv::Rect expanded(const cv::Rect& rect, int by) {
  return {rect.x - by, rect.y - by, rect.width + 2 * by, rect.height + 2 * by};
}

}  // namespace

FrameRenderer::FrameRenderer(const CameraModel& camera, const Field& field, const MarkerLayout& layout,
                             const RenderSpec& spec, Rng rng, const StaticScene& statics)
    : camera_(checked(camera, spec)),
      field_(field),
      layout_(layout),
      spec_(spec),
      rng_(rng),
      noise_(spec.format, spec.noise, camera.parameters().width_px, rng_) {
  // The kernel extends to three standard deviations from its centre.
  if (spec_.blur_px > kMinBlur_px) blur_size_ = 2 * static_cast<int>(std::ceil(3 * spec_.blur_px - 0.5)) + 1;
  render_floor_once(statics);
}

void FrameRenderer::render_floor_once(const StaticScene& statics) {
  const Eigen::Vector3d& gain = spec_.colour_gain;
  Canvas neutral_floor = render_floor(camera_, field_, spec_, rng_);
  cover_ = draw_static(statics, camera_, field_, spec_, neutral_floor);
  cv::multiply(neutral_floor, cv::Scalar(gain.x(), gain.y(), gain.z()), floor_);
  floor_.copyTo(canvas_);
  clean_.resize(row_bytes() * static_cast<std::size_t>(canvas_.rows));
  blur({0, 0, canvas_.cols, canvas_.rows});
  clean_floor_ = clean_;
}

Eigen::Vector3d FrameRenderer::gain_at(const Vec2& p) const {
  return light_fraction_at(spec_, field_, p) * spec_.colour_gain;
}

void FrameRenderer::sort_objects(const Scene& scene) {
  objects_.clear();
  const auto add = [&](const Vec2& place_m, VisibleObject::Kind kind, std::size_t index) {
    objects_.push_back({(place_m - camera_.position_m().head<2>()).norm(), place_m, kind, index});
  };
  for (std::size_t i = 0; i < scene.robots.size(); ++i)
    add(scene.robots[i].position_m, VisibleObject::Kind::kRobot, i);
  for (std::size_t i = 0; i < scene.cylinders.size(); ++i)
    add(scene.cylinders[i].circle.centre_m, VisibleObject::Kind::kCylinder, i);
  if (scene.ball) add(scene.ball->position_m.head<2>(), VisibleObject::Kind::kBall, 0);
  std::sort(objects_.begin(), objects_.end(),
            [](const VisibleObject& a, const VisibleObject& b) { return a.distance_m > b.distance_m; });
}

cv::Rect FrameRenderer::draw_robot(const SceneRobot& robot) {
  const Eigen::Vector3d gain = gain_at(robot.position_m);
  dots_.clear();
  const auto add = [&](std::size_t number, const Marker& dot, Colour colour) {
    if ((robot.hidden_dots >> number & 1) == 0)
      dots_.push_back({dot.position_m, dot.radius_m, lit(named(colour).rgb, gain)});
  };
  if (const MarkerPattern* const pattern = layout_.find(robot.pattern)) {
    add(0, layout_.centre, layout_.team_colour(robot.team));
    for (std::size_t i = 0; i < layout_.dots.size(); ++i) add(i + 1, layout_.dots[i], pattern->colours[i]);
  }
  VerticalBody body;
  body.position_m = robot.position_m;
  body.heading_rad = robot.heading_rad;
  body.radius_m = spec_.robot.radius_m;
  body.front_m = spec_.robot.front_m;
  body.height_m = spec_.robot.height_m;
  body.top = lit(named(Colour::kBlack).rgb, gain);
  body.side = lit(kRobotSide, gain);
  body.dots = dots_;
  body.velocity_mps = robot.velocity_mps;
  body.angular_radps = robot.angular_radps;
  return draw(body, camera_, spec_.exposure_s, canvas_);
}

cv::Rect FrameRenderer::draw_cylinder(const SceneCylinder& cylinder) {
  VerticalBody body;
  body.position_m = cylinder.circle.centre_m;
  body.radius_m = cylinder.circle.radius_m;
  body.front_m = 2 * cylinder.circle.radius_m;
  body.height_m = cylinder.height_m;
  body.top = lit(cylinder.colour, gain_at(body.position_m));
  body.side = static_cast<float>(kCylinderSideBrightness) * body.top;
  body.velocity_mps = cylinder.velocity_mps;
  return draw(body, camera_, spec_.exposure_s, canvas_);
}

cv::Rect FrameRenderer::draw_object(const Scene& scene, const VisibleObject& object) {
  switch (object.kind) {
    case VisibleObject::Kind::kRobot:
      return draw_robot(scene.robots[object.index]);
    case VisibleObject::Kind::kCylinder:
      return draw_cylinder(scene.cylinders[object.index]);
    case VisibleObject::Kind::kBall:
      break;
  }
  const Light light = lit(named(Colour::kOrange).rgb, gain_at(scene.ball->position_m.head<2>()));
  return draw(*scene.ball, light, camera_, spec_.exposure_s, canvas_);
}

cv::Rect FrameRenderer::draw_visible_part(const Scene& scene, const VisibleObject& object) {
  if (cover_.samples.empty()) return draw_object(scene, object);
  canvas_.copyTo(before_);
  const cv::Rect drawn = draw_object(scene, object);
  if (!drawn.empty()) remove_hidden_parts(cover_, camera_, object.place_m, drawn, before_(drawn), canvas_);
  return drawn;
}

void FrameRenderer::blur(const cv::Rect& rect) {
  // OpenCV rounds identically on every machine only if the matrix is not a part of a larger one.
  const cv::Rect around = expanded(rect, blur_size_ / 2) & cv::Rect(0, 0, canvas_.cols, canvas_.rows);
  Canvas blurred = canvas_(around).clone();
  if (blur_size_ > 1)
    cv::GaussianBlur(blurred, blurred, {blur_size_, blur_size_}, spec_.blur_px, spec_.blur_px,
                     cv::BORDER_REPLICATE);
  for (int y = rect.y; y < rect.br().y; ++y) {
    std::uint8_t* const row = clean_.data() + row_bytes() * static_cast<std::size_t>(y);
    convert_pixels(spec_.format, blurred[y - around.y][rect.x - around.x].val, rect.width,
                   row + std::ptrdiff_t{rect.x} * bytes_per_pixel(spec_.format));
  }
}

void FrameRenderer::restore(const cv::Rect& rect) {
  floor_(rect).copyTo(canvas_(rect));
  const auto pixel_bytes = static_cast<std::size_t>(bytes_per_pixel(spec_.format));
  const std::size_t begin = static_cast<std::size_t>(rect.x) * pixel_bytes;
  const std::size_t bytes = static_cast<std::size_t>(rect.width) * pixel_bytes;
  for (int y = rect.y; y < rect.br().y; ++y) {
    const std::size_t at = row_bytes() * static_cast<std::size_t>(y) + begin;
    std::memcpy(clean_.data() + at, clean_floor_.data() + at, bytes);
  }
}

void FrameRenderer::render(const Scene& scene, std::uint8_t* pixels) {
  sort_objects(scene);
  changed_.clear();
  const cv::Rect image(0, 0, canvas_.cols, canvas_.rows);
  for (const VisibleObject& object : objects_) {
    const cv::Rect drawn = draw_visible_part(scene, object);
    if (!drawn.empty()) changed_.push_back(aligned_to_pairs(expanded(drawn, blur_size_ / 2)) & image);
  }
  for (const cv::Rect& rect : changed_) blur(rect);
  noise_.add(clean_.data(), canvas_.rows, rng_, pixels);
  for (const cv::Rect& rect : changed_) restore(rect);
}

Image FrameRenderer::render(const Scene& scene) {
  Image image(spec_.format, canvas_.cols, canvas_.rows);
  render(scene, image.pixels());
  return image;
}

}  // namespace sidestep
