// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/geometry/field.hpp"
#include "common/image/image.hpp"

namespace sidestep {

struct LandmarkWatchSettings {
  double spacing_m = 0.08;     ///< distance between landmarks along a line
  int reach_px = 8;            ///< maximum distance from its predicted place at which a line is searched
  int min_contrast = 30;       ///< minimum contrast of a line against the surface beside it, of 255
  double max_offset_px = 1.5;  ///< maximum offset of a landmark that counts as in place
  /// Minimum fraction of landmarks that are visible, and of these that are in place.
  double min_share = 0.7;
  int good_frames = 5;  ///< number of good frames until a lost camera is known again
};

/// Detects that a camera has been moved. In every image it locates points of the field's lines, whose pixels
/// the camera model predicts. Lines along x and along y are judged separately, because a shift along a line
/// is not visible on that line. After one bad image the camera counts as lost; it counts as known again after
/// several consecutive good images.
class LandmarkWatch {
 public:
  /// Throws std::invalid_argument if the camera sees too few points of the lines in either direction.
  LandmarkWatch(const CameraModel& camera, const Field& field, const LandmarkWatchSettings& settings = {});

  /// Processes an image of the camera's size. Returns whether the camera is known.
  bool update(const ImageView& image);
  bool is_known() const { return is_known_; }

 private:
  struct Landmark {
    Vec2 pixel, normal;  ///< position, and normal of the line in the image
  };
  static constexpr std::size_t kMinLandmarks = 20;  // minimum number in each direction

  void add_line(const CameraModel& camera, const Vec2& from_m, const Vec2& to_m);
  bool is_in_place(const ImageView& image, const std::vector<Landmark>& landmarks) const;

  LandmarkWatchSettings settings_;
  std::array<std::vector<Landmark>, 2> landmarks_;  // with normals along x and along y of the image
  bool is_known_ = true;
  int good_frames_ = 0;
};

}  // namespace sidestep
