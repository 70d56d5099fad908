// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/geometry/field.hpp"
#include "common/image/image.hpp"

namespace sidestep {

struct LandmarkWatchSettings {
  double spacing_m = 0.08;     ///< between landmarks along a line
  int reach_px = 8;            ///< how far from its place a line is searched for
  int min_contrast = 30;       ///< of a line against the surface beside it, of 255
  double max_offset_px = 1.5;  ///< of a landmark that is in its place
  double min_share = 0.7;      ///< of the landmarks that are visible, and of those the ones in their places
  int good_frames = 5;         ///< until a lost camera is known again
};

/// Notices that a camera has been moved: registers points of the field's lines, whose pixels the camera model
/// predicts, in every image. Lines along x and along y are judged apart, because a shift along a line cannot
/// be seen on it. One bad image suffices to lose the camera; several good ones in a row are needed to know it
/// again.
class LandmarkWatch {
 public:
  /// Throws std::invalid_argument if the camera sees too few points of the lines in either direction.
  LandmarkWatch(const CameraModel& camera, const Field& field, const LandmarkWatchSettings& settings = {});

  /// Registers an image of the camera's size; returns whether the camera is known.
  bool update(const ImageView& image);
  bool is_known() const { return is_known_; }

 private:
  struct Landmark {
    Vec2 pixel, normal;  ///< the normal of the line in the image
  };
  static constexpr std::size_t kMinLandmarks = 20;  // in each direction

  void add_line(const CameraModel& camera, const Vec2& from_m, const Vec2& to_m);
  bool is_in_place(const ImageView& image, const std::vector<Landmark>& landmarks) const;

  LandmarkWatchSettings settings_;
  std::array<std::vector<Landmark>, 2> landmarks_;  // with normals along x, and along y of the image
  bool is_known_ = true;
  int good_frames_ = 0;
};

}  // namespace sidestep
