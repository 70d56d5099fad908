// SPDX-License-Identifier: Apache-2.0
#include "simulator/rendering/static_obstacles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulator/rendering/coverage/sample_pattern.hpp"
#include "simulator/rendering/field_surface.hpp"
#include "simulator/rendering/footprint.hpp"

namespace sidestep {
namespace {

constexpr int kSquare_px = 16;            // side of a square of pixels that shares a list of candidate shapes
constexpr float kSideBrightness = 0.55F;  // relative to the top
constexpr int kFrontSteps = 12;           // number of bisections along a viewing ray

double half_thickness_m(const Shape& shape) {
  return std::holds_alternative<Segment>(shape) ? kBoardHalfThickness_m : 0;
}

/// Whether all cells that intersect a box are blocked; the outside counts as blocked.
bool is_covered(const OccupancyMap& map, const Box& box) {
  const CellRange range = map.grid().cells_intersecting(box);
  const int end = range.last.column + 1;
  for (int row = range.first.row; row <= range.last.row; ++row)
    if (map.blocked().find_clear(range.first.column, end, row) < end) return false;
  return true;
}

/// The surface that a viewing ray shows.
enum class Seen { kFloor, kSide, kTop };

/// The part of a viewing ray between the height of the obstacles' tops and the floor.
class StaticView {
 public:
  StaticView(const StaticScene& scene, const CameraModel& camera)
      : scene_(scene),
        camera_(camera),
        parallax_(scene.height_m / (camera.position_m().z() - scene.height_m)),
        nadir_m_(camera.position_m().head<2>()) {}

  /// Sets candidates_ to the shapes that rays passing near a point at the height of the tops may meet.
  void select(const Vec2& top_m, double reach_m) {
    candidates_.clear();
    const Segment ray = ray_of(top_m);
    const double ray_reach_m = (1 + parallax_) * reach_m;
    for (const Shape& shape : scene_.shapes) {
      const double max_m = ray_reach_m + half_thickness_m(shape);
      if (squared_distance(ray, shape) <= max_m * max_m) candidates_.push_back(&shape);
    }
    is_map_near_ = scene_.map && scene_.map->cells().touches(ray.from_m, ray.to_m, ray_reach_m);
  }
  bool has_candidates() const { return is_map_near_ || !candidates_.empty(); }

  Seen seen(const Vec2& top_m) const {
    if (is_in_top(top_m)) return Seen::kTop;
    return meets(ray_of(top_m)) ? Seen::kSide : Seen::kFloor;
  }

  /// Whether all rays within this reach show tops. Conservative: never falsely true.
  bool shows_only_tops(const Vec2& top_m, double reach_m) const {
    const Vec2 reach(reach_m, reach_m);
    return std::ranges::any_of(candidates_,
                               [&](const Shape* shape) {
                                 return signed_distance(top_m, *shape) - half_thickness_m(*shape) < -reach_m;
                               }) ||
           (is_map_near_ && is_covered(scene_.map->cells(), {top_m - reach, top_m + reach}));
  }

  /// The distance from the point below the camera to the first obstacle along a ray that meets one.
  double front_m(const Vec2& top_m) const {
    const Segment ray = ray_of(top_m);
    double low = 0, high = 1;
    for (int step = 0; step < kFrontSteps && !is_in_top(top_m); ++step) {
      const double middle = 0.5 * (low + high);
      (meets({ray.from_m, ray.from_m + middle * (ray.to_m - ray.from_m)}) ? high : low) = middle;
    }
    const double share = is_in_top(top_m) ? 0 : high;
    return (ray.from_m + share * (ray.to_m - ray.from_m) - nadir_m_).norm();
  }

 private:
  Segment ray_of(const Vec2& top_m) const { return {top_m, top_m + parallax_ * (top_m - nadir_m_)}; }

  bool is_in_top(const Vec2& top_m) const {
    return std::ranges::any_of(candidates_,
                               [&](const Shape* shape) {
                                 return signed_distance(top_m, *shape) <= half_thickness_m(*shape);
                               }) ||
           (is_map_near_ && scene_.map->cells().is_blocked(scene_.map->cells().cell_at(top_m)));
  }

  bool meets(const Segment& ray) const {
    return std::ranges::any_of(candidates_,
                               [&](const Shape* shape) {
                                 const double max_m = half_thickness_m(*shape);
                                 return squared_distance(ray, *shape) <= max_m * max_m;
                               }) ||
           (is_map_near_ && touches(scene_.map->cells(), scene_.map->field(), ray.from_m, ray.to_m, 0));
  }

  const StaticScene& scene_;
  const CameraModel& camera_;
  double parallax_;
  Vec2 nadir_m_;
  std::vector<const Shape*> candidates_;
  bool is_map_near_ = false;
};

/// Draws the obstacles into the floor, square by square.
class StaticPainter {
 public:
  StaticPainter(const StaticScene& scene, const CameraModel& camera, const Field& field,
                const RenderSpec& spec, Canvas& floor)
      : scene_(scene), camera_(camera), field_(field), spec_(spec), floor_(floor), view_(scene, camera) {
    cover_.samples = cv::Mat1b::zeros(floor.size());
    cover_.front_m = cv::Mat1f::zeros(floor.size());
  }

  StaticOcclusion paint() {
    for (int y = 0; y < floor_.rows; y += kSquare_px)
      for (int x = 0; x < floor_.cols; x += kSquare_px) paint_square({x, y, kSquare_px, kSquare_px});
    return std::move(cover_);
  }

 private:
  void paint_square(const cv::Rect& square) {
    const Vec2 corner(square.x - 0.5, square.y - 0.5), side(square.width, square.height);
    const auto middle_m = camera_.point_at(corner + side / 2, scene_.height_m);
    if (!middle_m) return;
    double reach_m = 0;
    for (const Vec2& share : {Vec2(0, 0), Vec2(0, 1), Vec2(1, 0), Vec2(1, 1)}) {
      const auto point_m = camera_.point_at(corner + side.cwiseProduct(share), scene_.height_m);
      if (point_m) reach_m = std::max(reach_m, (*point_m - *middle_m).norm());
    }
    view_.select(*middle_m, 1.2 * reach_m);
    if (!view_.has_candidates()) return;
    const cv::Rect part = square & cv::Rect(0, 0, floor_.cols, floor_.rows);
    for (int y = part.y; y < part.br().y; ++y)
      for (int x = part.x; x < part.br().x; ++x) paint_pixel(x, y);
  }

  void paint_pixel(int x, int y) {
    const auto top_m = camera_.point_at(Vec2(x, y), scene_.height_m);
    if (!top_m) return;
    const auto slope = camera_.projection_jacobian(Vec3(top_m->x(), top_m->y(), scene_.height_m));
    if (!slope) return;
    const Eigen::Matrix2d metres_per_pixel = slope->leftCols<2>().inverse();
    int tops = 0, sides = 0;
    if (view_.shows_only_tops(*top_m, pixel_reach_m(metres_per_pixel))) {
      tops = kSamples;
      cover_.front_m(y, x) = static_cast<float>(view_.front_m(*top_m));
    } else {
      count_samples(*top_m, metres_per_pixel, tops, sides, cover_.front_m(y, x));
    }
    if (tops + sides == 0) return;
    cover_.samples(y, x) = static_cast<std::uint8_t>(tops + sides);
    const auto light = static_cast<float>(light_fraction_at(spec_, field_, *top_m));
    const Light top = light * lit(scene_.colour, {1, 1, 1});
    const auto rest = static_cast<float>(static_cast<int>(kSamples) - tops - sides);
    floor_(y, x) =
        bytes_of((static_cast<float>(tops) * top + static_cast<float>(sides) * kSideBrightness * top +
                  rest * light_of(floor_(y, x))) /
                 static_cast<float>(kSamples));
  }

  void count_samples(const Vec2& top_m, const Eigen::Matrix2d& metres_per_pixel, int& tops, int& sides,
                     float& front_m) const {
    for (std::size_t i = 0; i < kSamples; ++i) {
      const Vec2 sample_m = top_m + metres_per_pixel * Vec2(kSamplePattern.x[i], kSamplePattern.y[i]);
      const Seen seen = view_.seen(sample_m);
      if (seen == Seen::kFloor) continue;
      if (tops + sides == 0) front_m = static_cast<float>(view_.front_m(sample_m));
      ++(seen == Seen::kTop ? tops : sides);
    }
  }

  const StaticScene& scene_;
  const CameraModel& camera_;
  const Field& field_;
  const RenderSpec& spec_;
  Canvas& floor_;
  StaticView view_;
  StaticOcclusion cover_;
};

}  // namespace

StaticOcclusion draw_static(const StaticScene& scene, const CameraModel& camera, const Field& field,
                            const RenderSpec& spec, Canvas& floor) {
  if (scene.empty() || camera.position_m().z() <= scene.height_m) return {};
  return StaticPainter(scene, camera, field, spec, floor).paint();
}

void remove_hidden_parts(const StaticOcclusion& cover, const CameraModel& camera, const Vec2& object_m,
                         const cv::Rect& rect, const Canvas& before, Canvas& canvas) {
  const Vec2 nadir_m = camera.position_m().head<2>();
  for (int y = rect.y; y < rect.br().y; ++y) {
    for (int x = rect.x; x < rect.br().x; ++x) {
      const std::uint8_t samples = cover.samples(y, x);
      if (samples == 0) continue;
      const auto floor_m = camera.point_at(Vec2(x, y), 0);
      if (!floor_m) continue;
      const Vec2 along = (*floor_m - nadir_m).normalized();
      if (along.dot(object_m - nadir_m) <= cover.front_m(y, x)) continue;
      const float share = static_cast<float>(samples) / static_cast<float>(kSamples);
      canvas(y, x) =
          bytes_of(share * light_of(before(y - rect.y, x - rect.x)) + (1 - share) * light_of(canvas(y, x)));
    }
  }
}

}  // namespace sidestep
