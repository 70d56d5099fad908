// SPDX-License-Identifier: Apache-2.0
#include "tests/study/camera/pixel_guide.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "common/geometry/convex_hull.hpp"
#include "tests/study/measurement/cpu_clock.hpp"
#include "vision/colours/default_colours.hpp"

namespace sidestep {
namespace {

constexpr double kGuideRadius_m = 0.09, kGuideHeight_m = 0.15;  // of the robot
constexpr double kObstacleHeight_m = 0.15;
/// Covers tracking errors, cut corners and a slightly misplaced camera.
constexpr double kGuideMargin_m = 0.045;

constexpr PathFollowerSettings kFollowing{10, 4, 10};  // in pixels
constexpr SegmentationSettings kSegmentation{3, 1};

/// Measures the processor time of a stage.
template <typename Stage>
auto timed(Distribution& times, const Stage& stage) {
  const double begin_us = cpu_us();
  if constexpr (std::is_void_v<decltype(stage())>) {
    stage();
    times.add(cpu_us() - begin_us);
  } else {
    auto result = stage();
    times.add(cpu_us() - begin_us);
    return result;
  }
}

/// The largest scale of the image on the floor, in pixels per metre.
double max_px_per_m(const CameraModel& camera) {
  double scale = 0;
  for (int i = 0; i <= 16; ++i) {
    for (int k = 0; k <= 16; ++k) {
      const Vec2 pixel(camera.parameters().width_px * i / 16.0, camera.parameters().height_px * k / 16.0);
      const auto point_m = camera.point_at(pixel, 0);
      if (!point_m) continue;
      const auto slope = camera.projection_jacobian({point_m->x(), point_m->y(), 0});
      if (!slope) continue;
      scale = std::max({scale, slope->col(0).norm(), slope->col(1).norm()});
    }
  }
  return scale;
}

FloorBlobSettings blob_settings(const CameraModel& camera, double height_m) {
  FloorBlobSettings settings;
  const Vec2 below_m = camera.position_m().head<2>();
  settings.below_camera_px =
      camera.pixel_of({below_m.x(), below_m.y(), 0}).value_or(camera.parameters().principal_point_px);
  settings.foot_distance_ratio = 1 - height_m / camera.position_m().z();
  return settings;
}

}  // namespace

PixelGuide::PixelGuide(const CameraModel& camera, const Field& field, PixelPlanner planner)
    : camera_(camera),
      planner_(planner),
      centre_px_(0.5 * Vec2(camera.parameters().width_px - 1, camera.parameters().height_px - 1)),
      radius_px_((kGuideRadius_m + kGuideMargin_m) * max_px_per_m(camera)),
      segmenter_(ColourClasses(default_colours(PixelFormat::kYuv422).boxes), kSegmentation),
      finder_(blob_settings(camera, kObstacleHeight_m)),
      watch_(camera, field),
      cells_(camera.parameters().width_px, camera.parameters().height_px),
      follower_(kFollowing) {}

/// Finds obstacles, robot and target. The robot's dot is at the height of its top, so its position is the
/// pixel of the floor point below the dot.
void PixelGuide::look(const ImageView& image) {
  image_ = image;
  const auto regions = timed(times_.segmentation, [&] { return segmenter_.segment(image); });
  blobs_ = timed(times_.blobs, [&] { return &finder_.find(image, segmenter_.classes(), regions); });
  has_robot_ = false;
  if (blobs_->robot) {
    const auto robot_m = camera_.point_at(*blobs_->robot, kGuideHeight_m);
    const auto pixel = robot_m ? camera_.pixel_of({robot_m->x(), robot_m->y(), 0}) : std::nullopt;
    has_robot_ = pixel && camera_.is_in_image(*pixel);
    if (has_robot_) robot_px_ = *pixel;
  }
  // A target that is not seen keeps its last position: the robot hides it, or it will soon be seen elsewhere.
  if (!blobs_->target) return;
  target_px_ = *blobs_->target;
  has_target_ = true;
}

std::vector<Vec2> PixelGuide::plan_on_cells() {
  timed(times_.cells,
        [&] { mark_cells(image_, segmenter_.classes(), finder_, blobs_->obstacles, radius_px_, cells_); });
  return timed(times_.astar, [&] {
    const CellRoute& route = astar_.search(cells_.blocked, robot_cell(), target_cell());
    std::vector<Vec2> path;
    if (route.cells.empty()) return path;
    path.push_back(robot_px_);
    for (const Cell& cell : route.cells) path.push_back(cells_.centre_of(cell));
    path.push_back(target_px_);
    return path;
  });
}

std::vector<Vec2> PixelGuide::plan_around(std::vector<Shape> shapes) {
  const ObstacleWorld world(std::move(shapes));
  const CameraParameters& size = camera_.parameters();
  const Field image{static_cast<double>(size.width_px), static_cast<double>(size.height_px)};
  const DiscDomain domain(world, image, radius_px_, to_plane(robot_px_), to_plane(target_px_));
  const Plan<Vec2>& plan = visibility_.plan(domain, to_plane(robot_px_), {}, rng_);
  std::vector<Vec2> path;
  if (!plan.arrives()) return path;
  for (const Vec2& state : plan.states) path.push_back(to_pixel(state));
  return path;
}

std::vector<Vec2> PixelGuide::plan_around_diamonds() {
  return timed(times_.diamonds, [&] {
    std::vector<Shape> shapes;
    for (const ObstacleBlob& blob : blobs_->obstacles) {
      std::vector<Vec2> corners;
      for (const Vec2& corner : blob.diamond) corners.push_back(to_plane(corner));
      shapes.emplace_back(ConvexPolygon{convex_hull(std::move(corners))});
    }
    return plan_around(std::move(shapes));
  });
}

std::vector<Vec2> PixelGuide::plan_around_discs() {
  return timed(times_.discs, [&] {
    std::vector<Shape> shapes;
    for (const ObstacleBlob& blob : blobs_->obstacles)
      shapes.emplace_back(Circle{to_plane(blob.centre), blob.radius_px});
    return plan_around(std::move(shapes));
  });
}

std::vector<Vec2> PixelGuide::plan(PixelPlanner planner) {
  switch (planner) {
    case PixelPlanner::kCells:
      return plan_on_cells();
    case PixelPlanner::kDiamonds:
      return plan_around_diamonds();
    case PixelPlanner::kDiscs:
      return plan_around_discs();
  }
  return {};
}

PixelPaths PixelGuide::plan_all() {
  PixelPaths paths;
  if (!has_robot_ || !has_target_) return paths;
  for (std::size_t i = 0; i < kPixelPlanners; ++i) paths[i] = plan(static_cast<PixelPlanner>(i));
  return paths;
}

PixelGuide::Guidance PixelGuide::guide(const ImageView& image) {
  Guidance guidance;
  guidance.camera_is_known = timed(times_.registration, [&] { return watch_.update(image); });
  if (!guidance.camera_is_known) return guidance;
  look(image);
  if (!has_robot_) return guidance;
  guidance.robot_m = camera_.point_at(robot_px_, 0);
  if (!has_target_) return guidance;
  guidance.to_target_m = (*camera_.point_at(target_px_, 0) - *guidance.robot_m).norm();
  guidance.replanned = follower_.replan_reason(robot_px_, target_px_);
  if (guidance.replanned != ReplanReason::kNone) {
    follower_.follow(plan(planner_), target_px_);
    if (follower_.path().empty()) return guidance;
  }
  guidance.carrot_m = camera_.point_at(follower_.carrot(robot_px_), 0);
  return guidance;
}

}  // namespace sidestep
