// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/field_surface.hpp"

#include <algorithm>
#include <cmath>

#include "common/marking/colours.hpp"
#include "simulator/rendering/coverage/sample_pattern.hpp"
#include "simulator/rendering/footprint.hpp"

namespace sidestep {
namespace {

constexpr double kMargin_m = 0.3;  // width of the field surface outside the lines
constexpr Rgb kSurroundings{58, 56, 54};

/// The fractions of a point or pixel that show a line and the field surface, without texture. The rest shows
/// the surroundings.
struct Coverage {
  float line = 0, surface = 0;
};

class FloorCoverage {
 public:
  explicit FloorCoverage(const Field& field) : lines_(field) {
    const Vec2 half(field.length_m / 2 + kMargin_m, field.width_m / 2 + kMargin_m);
    surface_ = {-half, half};
  }

  Coverage at_point(const Vec2& p) const {
    return at_point(lines_.distance_m(p), signed_distance(p, surface_));
  }

  Coverage at_pixel(const CameraModel& camera, const Vec2& p) const {
    const double line_m = lines_.distance_m(p), surface_m = signed_distance(p, surface_);
    const Coverage centre = at_point(line_m, surface_m);
    const double edge_m = std::min(std::abs(line_m), std::abs(surface_m));
    // Larger than any pixel, so that the exact pixel size is needed only near edges.
    constexpr double kFar_m = 0.1;
    if (edge_m > kFar_m) return centre;
    const auto slope = camera.projection_jacobian(Vec3(p.x(), p.y(), 0));
    if (!slope) return centre;
    const Eigen::Matrix2d metres_per_pixel = slope->leftCols<2>().inverse();
    if (edge_m > pixel_reach_m(metres_per_pixel)) return centre;
    Coverage sum;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const Coverage sample = at_point(p + metres_per_pixel * Vec2(kSamplePattern.x[i], kSamplePattern.y[i]));
      sum.line += sample.line / static_cast<float>(kSamples);
      sum.surface += sample.surface / static_cast<float>(kSamples);
    }
    return sum;
  }

 private:
  /// Coverage of a point with these signed distances to the edges of the nearest line and of the field
  /// surface.
  static Coverage at_point(double line_m, double surface_m) {
    if (line_m <= 0) return {1, 0};
    return {0, surface_m <= 0 ? 1.0F : 0.0F};
  }

  FieldLines lines_;
  Box surface_;
};

}  // namespace

FieldLines::FieldLines(const Field& field) : marking_(field) {
  std::ranges::transform(marking_.lines, lines_.begin(), [](const MarkedLine& line) {
    const auto& [from_m, to_m] = line.segment_m;
    return Box{from_m.cwiseMin(to_m), from_m.cwiseMax(to_m)};
  });
}

double FieldLines::distance_m(const Vec2& p) const {
  double centre_m = std::abs(p.norm() - marking_.centre_circle_radius_m);
  for (const Box& line : lines_) {
    // A cheap lower bound on the distance excludes most lines.
    const Vec2 beyond_m = (line.min_m - p).cwiseMax(p - line.max_m);
    if (beyond_m.maxCoeff() < centre_m) centre_m = std::min(centre_m, signed_distance(p, line));
  }
  return centre_m - marking_.line_m / 2;
}

double light_fraction_at(const RenderSpec& spec, const Field& field, const Vec2& p) {
  const Vec2 half(field.length_m / 2, field.width_m / 2);
  const double fraction =
      spec.light_falloff == LightFalloff::kLinear ? (p.x() / half.x() + 1) / 2 : p.norm() / half.norm();
  return 1 - (1 - spec.far_light) * std::clamp(fraction, 0.0, 1.0);
}

Canvas render_floor(const CameraModel& camera, const Field& field, const RenderSpec& spec, Rng& rng) {
  const FloorCoverage floor(field);
  const Eigen::Vector3d full(1, 1, 1);
  const Light surface = lit(named(Colour::kField).rgb, full), line = lit(named(Colour::kWhite).rgb, full);
  const Light surroundings = lit(kSurroundings, full);
  Canvas canvas(camera.parameters().height_px, camera.parameters().width_px);
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      const auto texture = static_cast<float>(1 + spec.surface_texture * rng.normal());
      const auto p = camera.point_at(Vec2(x, y), 0);
      if (!p) {
        canvas(y, x) = bytes_of(surroundings);
        continue;
      }
      const Coverage share = floor.at_pixel(camera, *p);
      const Light seen = share.line * line + share.surface * texture * surface +
                         (1 - share.line - share.surface) * surroundings;
      canvas(y, x) = bytes_of(static_cast<float>(light_fraction_at(spec, field, *p)) * seen);
    }
  }
  return canvas;
}

}  // namespace sidestep
