// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "agents/navigation/path_follower.hpp"
#include "agents/planning/grids/cell_astar.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "common/camera/camera_model.hpp"
#include "common/image/image.hpp"
#include "tests/study/measurement/distribution.hpp"
#include "vision/pixel_map/floor_blobs.hpp"
#include "vision/pixel_map/landmark_watch.hpp"
#include "vision/pixel_map/pixel_cells.hpp"
#include "vision/segmentation/segmenter.hpp"

namespace sidestep {

/// How the path is planned.
enum class PixelPlanner {
  kCells,     ///< A* on cells of 10 x 10 pixels
  kDiamonds,  ///< the visibility graph around the blobs' diamonds
  kDiscs,     ///< the visibility graph around the blobs' discs
};
inline constexpr std::size_t kPixelPlanners = 3;

/// Paths in pixels, indexed by PixelPlanner; an empty path means none was found.
using PixelPaths = std::array<std::vector<Vec2>, kPixelPlanners>;

/// Times of the stages in microseconds of processor time.
struct StageTimes {
  Distribution registration, segmentation, blobs, cells, astar, diamonds, discs;
};

/// Guides a robot to a target using only the images of one camera: determines from each image where to drive.
class PixelGuide {
 public:
  PixelGuide(const CameraModel& camera, const Field& field, PixelPlanner planner);

  struct Guidance {
    bool camera_is_known = true;
    std::optional<Vec2> robot_m;   ///< nullopt: not found in the image
    std::optional<Vec2> carrot_m;  ///< the place to drive to; nullopt: stop
    ReplanReason replanned = ReplanReason::kNone;
    double to_target_m = 1e9;
  };
  Guidance guide(const ImageView& image);

  /// Plans with all planners, using the last image. For comparisons and pictures.
  PixelPaths plan_all();
  const FloorBlobs& blobs() const { return *blobs_; }
  const PixelCells& cells() const { return cells_; }
  const StageTimes& times() const { return times_; }
  const CellAstar& astar() const { return astar_; }
  double radius_px() const { return radius_px_; }
  /// Cells of robot and target in the last image. Precondition: both were found.
  Cell robot_cell() const { return cells_.cell_at(robot_px_); }
  Cell target_cell() const { return cells_.cell_at(target_px_); }

 private:
  void look(const ImageView& image);
  std::vector<Vec2> plan(PixelPlanner planner);
  std::vector<Vec2> plan_on_cells();
  std::vector<Vec2> plan_around(std::vector<Shape> shapes);
  std::vector<Vec2> plan_around_diamonds();
  std::vector<Vec2> plan_around_discs();
  /// Convert between pixels and a plane whose y axis points up and whose origin is the image's centre.
  Vec2 to_plane(const Vec2& pixel) const { return {pixel.x() - centre_px_.x(), centre_px_.y() - pixel.y()}; }
  Vec2 to_pixel(const Vec2& p) const { return {p.x() + centre_px_.x(), centre_px_.y() - p.y()}; }

  CameraModel camera_;
  PixelPlanner planner_;
  Vec2 centre_px_;
  double radius_px_;
  Segmenter segmenter_;
  FloorBlobFinder finder_;
  LandmarkWatch watch_;
  PixelCells cells_;
  CellAstar astar_;
  LazyVisibility visibility_;
  Rng rng_{1};
  PathFollower follower_;
  const FloorBlobs* blobs_ = nullptr;
  ImageView image_;
  Vec2 robot_px_{0, 0}, target_px_{0, 0};
  bool has_robot_ = false, has_target_ = false;
  StageTimes times_;
};

}  // namespace sidestep
