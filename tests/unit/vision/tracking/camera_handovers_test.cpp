// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/camera_handovers.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "tests/catch.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::camera_handovers_test {

using namespace sidestep::test;

/// Two cameras whose views overlap, and which are wrong by these errors.
class TwoViews {
 public:
  std::vector<Vec2> errors_m{Vec2(0, 0), Vec2(0.04, 0.01)};
  double delay_s = 0.005;  ///< of the second camera's frames after the first's

  /// Shows a robot that is at `position_m` to one of the cameras. Returns where it is seen; nullopt if not.
  std::optional<Vec2> show(std::uint32_t camera, double at_s, const Vec2& position_m) {
    msg::DetectionFrame message = frame_message(camera, after_s(at_s));
    add_robot(message, 0, position_m + errors_m[camera]);
    frame_.assign(message, after_s(at_s));
    REQUIRE(frame_.is_usable());
    handovers.shift(frame_);
    if (frame_.robots().empty()) return std::nullopt;
    return frame_.robots()[0].position_m;
  }

  CameraHandovers handovers{0.0002};

 private:
  Frame frame_;
};

TEST_CASE("a robot that passes from one camera to another does not jump, and its shift fades") {
  const double speed_mps = GENERATE(0.0, 0.5, 2.0);
  CAPTURE(speed_mps);
  TwoViews views;
  double max_step_m = 0, max_error_m = 0, last_error_m = 0;
  std::optional<Vec2> last_difference_m;
  for (int i = 0; i < 600; ++i) {
    const double at_s = 1 + i / 60.0;
    for (const std::uint32_t camera : {0U, 1U}) {
      if (camera == 0 ? i > 30 : i < 20) continue;
      const double seen_at_s = at_s + camera * views.delay_s;
      const Vec2 true_m((seen_at_s - 1) * speed_mps, 0);
      const auto seen_m = views.show(camera, seen_at_s, true_m);
      if (camera == 1 && i < 22) CHECK_FALSE(seen_m);
      if (!seen_m) continue;
      const Vec2 difference_m = *seen_m - true_m;
      if (last_difference_m) max_step_m = std::max(max_step_m, (difference_m - *last_difference_m).norm());
      last_difference_m = difference_m;
      max_error_m = std::max(max_error_m, difference_m.norm());
      last_error_m = (difference_m - views.errors_m[camera]).norm();
    }
    views.handovers.advance(kFrame);
  }
  // While both cameras see it, the shift of one has faded by this much.
  CHECK(max_step_m < 11 / 60.0 * CameraOffsets::kMaxChange_mps + 1e-4);
  CHECK(max_error_m <= views.errors_m[1].norm() + 1e-9);
  CHECK(last_error_m < 1e-9);
}

TEST_CASE("cameras that differ only by their noise shift no robot") {
  const double noise_m = GENERATE(0.0015, 0.008);
  Rng rng(1);
  int shifted = 0;
  for (int trial = 0; trial < 200; ++trial) {
    TwoViews views;
    views.handovers = CameraHandovers(noise_m);
    for (int i = 0; i < 10; ++i) {
      for (const std::uint32_t camera : {0U, 1U}) {
        if (camera == 1 && i < 4) continue;
        views.errors_m[camera] = noise_m * normal_vector(rng);
        const auto seen_m = views.show(camera, 1 + i / 60.0 + camera * views.delay_s, {1, 1});
        shifted += seen_m && (*seen_m - Vec2(1, 1) - views.errors_m[camera]).norm() > 1e-9 ? 1 : 0;
      }
    }
  }
  CHECK(shifted == 0);
}

TEST_CASE("a robot that only one camera sees is never removed or shifted") {
  TwoViews views;
  for (int i = 0; i < 100; ++i) CHECK(views.show(1, 1 + i / 60.0, {1, 1}) == Vec2(1, 1) + views.errors_m[1]);
}

TEST_CASE("cameras that see a robot at different places are not taken for badly calibrated") {
  TwoViews views;
  views.errors_m[1] = {0.3, 0};
  for (int i = 0; i < 20; ++i) {
    views.show(0, 1 + i / 60.0, {1, 1});
    const auto seen_m = views.show(1, 1 + i / 60.0 + views.delay_s, {1, 1});
    if (i > 1) CHECK(seen_m == Vec2(1.3, 1));
  }
}

TEST_CASE("a false detection shifts no robot") {
  const int false_frame = GENERATE(9, 10, 11, 12);
  const std::uint32_t false_camera = GENERATE(0U, 1U);
  CAPTURE(false_frame, false_camera);
  TwoViews views;
  views.errors_m[1] = {0, 0};
  for (int i = 0; i < 30; ++i) {
    for (const std::uint32_t camera : {0U, 1U}) {
      if (camera == 1 && i < 10) continue;
      const bool is_false = i == false_frame && camera == false_camera;
      const Vec2 shown_m(is_false ? 1.1 : 1, 1);
      const auto seen_m = views.show(camera, 1 + i / 60.0 + camera * views.delay_s, shown_m);
      if (seen_m) CHECK((*seen_m - shown_m).norm() < 1e-9);
      if (i > 15) CHECK(seen_m);
    }
  }
}

TEST_CASE("a camera is used as it is if the other stops seeing the robot at once") {
  TwoViews views;
  for (int i = 0; i < 10; ++i) views.show(0, 1 + i / 60.0, {1, 1});
  int removed = 0;
  for (int i = 10; i < 30; ++i) removed += views.show(1, 1 + i / 60.0, {1, 1}) ? 0 : 1;
  CHECK(removed > 0);
  CHECK(removed < 5);
}

TEST_CASE("a robot that comes back to a camera is handed over again") {
  TwoViews views;
  const auto seen_by = [&](std::uint32_t camera, double from_s, double to_s) {
    std::optional<Vec2> seen_m;
    for (double at_s = from_s; at_s < to_s; at_s += 1 / 60.0) seen_m = views.show(camera, at_s, {1, 1});
    return seen_m;
  };
  CHECK(seen_by(1, 1, 2) == Vec2(1, 1) + views.errors_m[1]);
  CHECK(seen_by(0, 3, 4) == Vec2(1, 1));
  for (int i = 0; i < 10; ++i) {
    const double at_s = 4 + i / 60.0;
    views.show(0, at_s, {1, 1});
    const auto seen_m = views.show(1, at_s + views.delay_s, {1, 1});
    if (i > 1) {
      REQUIRE(seen_m);
      CHECK((*seen_m - Vec2(1, 1)).norm() < 1e-9);
    }
  }
}

TEST_CASE("after the clock was set back, handovers begin anew") {
  TwoViews views;
  for (int i = 0; i < 10; ++i) views.show(0, 100 + i / 60.0, {1, 1});
  views.handovers.forget();
  CHECK(views.show(1, 1, {1, 1}) == Vec2(1, 1) + views.errors_m[1]);
}

}  // namespace sidestep::camera_handovers_test
