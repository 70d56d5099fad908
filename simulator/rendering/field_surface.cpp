// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/field_surface.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/box.hpp"
#include "common/marking/colours.hpp"
#include "simulator/rendering/counting/samples.hpp"
#include "simulator/rendering/footprint.hpp"

namespace sidestep {
namespace {

constexpr double kMargin_m = 0.3;  // of carpet outside the lines
constexpr Rgb kBeyond{58, 56, 54};

double border_distance_m(const Vec2& p, const Box& box) { return std::abs(signed_distance(p, box)); }

/// What a point of the floor is, without texture: the share of line and that of carpet; the rest is beyond.
struct Share {
  float line = 0, carpet = 0;
};

class FloorShares {
 public:
  explicit FloorShares(const Field& field) : lines_(field) {
    const Vec2 half(field.length_m / 2 + kMargin_m, field.width_m / 2 + kMargin_m);
    carpet_ = {-half, half};
  }

  Share of_point(const Vec2& p) const {
    if (lines_.distance_m(p) <= 0) return {1, 0};
    return {0, signed_distance(p, carpet_) <= 0 ? 1.0F : 0.0F};
  }

  Share of_pixel(const CameraModel& camera, const Vec2& p) const {
    const double edge_m = std::min(std::abs(lines_.distance_m(p)), std::abs(signed_distance(p, carpet_)));
    // Most pixels are far from all edges: far enough that their size need not be known well.
    constexpr double kFar_m = 0.1;
    if (edge_m > kFar_m) return of_point(p);
    const auto slope = camera.pixels_per_metre(Vec3(p.x(), p.y(), 0));
    if (!slope) return of_point(p);
    const Eigen::Matrix2d metres_per_pixel = slope->leftCols<2>().inverse();
    if (edge_m > pixel_reach_m(metres_per_pixel)) return of_point(p);
    Share sum;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const Share share = of_point(p + metres_per_pixel * Vec2(kSamplePattern.x[i], kSamplePattern.y[i]));
      sum.line += share.line / static_cast<float>(kSamples);
      sum.carpet += share.carpet / static_cast<float>(kSamples);
    }
    return sum;
  }

 private:
  FieldLines lines_;
  Box carpet_;
};

}  // namespace

double FieldLines::distance_m(const Vec2& p) const {
  const Vec2 half(field_.length_m / 2, field_.width_m / 2);
  const Vec2 q = p.cwiseAbs();  // all lines lie symmetrically
  double middle_m =
      std::min(border_distance_m(q, {-half, half}), std::abs(q.norm() - marking_.centre_circle_radius_m));
  const double outside_m = signed_distance(q, Box{-half, half});
  middle_m = std::min({middle_m, std::max(q.x(), outside_m), std::max(q.y(), outside_m)});
  const Box area{{half.x() - marking_.area_depth_m, -marking_.area_width_m / 2},
                 {half.x(), marking_.area_width_m / 2}};
  return std::min(middle_m, border_distance_m(q, area)) - marking_.line_m / 2;
}

double light_at(const RenderSpec& spec, const Field& field, const Vec2& p) {
  const Vec2 half(field.length_m / 2, field.width_m / 2);
  const double way =
      spec.light_fall == LightFall::kLinear ? (p.x() / half.x() + 1) / 2 : p.norm() / half.norm();
  return 1 - (1 - spec.far_light) * std::clamp(way, 0.0, 1.0);
}

Canvas sample_floor(const CameraModel& camera, const Field& field, const RenderSpec& spec, Rng& rng) {
  const FloorShares shares(field);
  const Eigen::Vector3d full(1, 1, 1);
  const Light carpet = lit(named(Colour::kField).rgb, full), line = lit(named(Colour::kWhite).rgb, full);
  const Light beyond = lit(kBeyond, full);
  Canvas canvas(camera.parameters().height_px, camera.parameters().width_px);
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      const auto texture = static_cast<float>(1 + spec.carpet_texture * rng.normal());
      const auto p = camera.point_at(Vec2(x, y), 0);
      if (!p) {
        canvas(y, x) = bytes_of(beyond);
        continue;
      }
      const Share share = shares.of_pixel(camera, *p);
      const Light seen =
          share.line * line + share.carpet * texture * carpet + (1 - share.line - share.carpet) * beyond;
      canvas(y, x) = bytes_of(static_cast<float>(light_at(spec, field, *p)) * seen);
    }
  }
  return canvas;
}

}  // namespace sidestep
