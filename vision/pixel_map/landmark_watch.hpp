// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/geometry/field.hpp"
#include "common/image/image.hpp"

namespace sidestep {

/// Detects that a camera has been moved. In every image it locates points of the field's lines, whose pixels
/// the camera model predicts. Lines along x and along y are judged separately, because a shift along a line
/// is not visible on that line. After one bad image the camera counts as lost: its pose is unknown. It counts
/// as known again after several consecutive good images.
class LandmarkWatch {
 public:
  /// Throws std::invalid_argument if the camera sees too few points of the lines in either direction.
  LandmarkWatch(const CameraModel& camera, const Field& field);

  /// Processes an image of the camera's size. Returns whether the camera's pose is known.
  bool update(const ImageView& image);
  bool is_known() const { return is_known_; }

 private:
  struct Landmark {
    Vec2 pixel, normal;  ///< position, and normal of the line in the image
  };
  static constexpr std::size_t kMinLandmarks = 20;  // minimum number in each direction

  void add_line(const CameraModel& camera, const Vec2& from_m, const Vec2& to_m);
  bool is_in_place(const ImageView& image, const std::vector<Landmark>& landmarks) const;

  std::array<std::vector<Landmark>, 2> landmarks_;  // with normals along x and along y of the image
  bool is_known_ = true;
  int good_frames_ = 0;
};

}  // namespace sidestep
