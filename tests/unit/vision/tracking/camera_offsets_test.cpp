// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/camera_offsets.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/catch.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::camera_offsets_test {

using namespace sidestep::test;

/// Cameras that each see robots with an offset, and not at the same time.
class BiasedCameras {
 public:
  BiasedCameras(std::uint64_t seed, std::vector<Vec2> offsets_m)
      : rng_(seed), offsets_m_(std::move(offsets_m)), measured_(numbers()) {}

  CameraOffsets& measured() { return measured_; }
  double noise_m = 0.0015;

  /// A robot drives in circles at a speed, seen by these cameras.
  void run(double duration_s, double speed_mps, const std::vector<std::uint32_t>& seeing) {
    for (const double end_s = now_s_ + duration_s; now_s_ < end_s; now_s_ += 1 / 60.0) {
      for (const std::uint32_t camera : seeing) {
        // The cameras' frames are spread over the period.
        const double at_s = now_s_ + camera * 0.004;
        const double angle_rad = at_s * speed_mps;
        const Pose pose{{std::cos(angle_rad), std::sin(angle_rad)}, {0, 0}, 0};
        msg::DetectionFrame message = frame_message(camera, after_s(at_s));
        add_noisy_robot(message, 0, {pose.position_m + offsets_m_[camera], {0, 0}, 0}, {noise_m, 0.005},
                        rng_);
        frame_.assign(message, after_s(at_s));
        REQUIRE(frame_.is_usable());
        measured_.add(frame_);
      }
      measured_.advance(kFrame);
    }
  }

  /// How far apart the cameras see the robot after the correction.
  double corrected_disagreement_m(std::uint32_t a, std::uint32_t b) const {
    return (offsets_m_[a] + measured_.correction_m(a) - offsets_m_[b] - measured_.correction_m(b)).norm();
  }

 private:
  std::vector<std::uint32_t> numbers() const {
    std::vector<std::uint32_t> numbers(offsets_m_.size());
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
  }

  Rng rng_;
  std::vector<Vec2> offsets_m_;
  double now_s_ = 1;
  CameraOffsets measured_;
  Frame frame_;
};

TEST_CASE("the disagreement of two cameras is measured within a tenth, and corrected") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  Rng rng(seed);
  for (const double offset_m : {0.01, 0.02, 0.04, 0.06}) {
    for (const double speed_mps : {0.0, 0.5, 2.0}) {
      CAPTURE(seed, offset_m, speed_mps);
      const double angle_rad = rng.uniform(0, 2 * std::numbers::pi);
      BiasedCameras cameras(seed, {Vec2(0, 0), rotated(Vec2(offset_m, 0), angle_rad)});
      cameras.run(1, speed_mps, {0, 1});
      const auto pairs = cameras.measured().pairs();
      REQUIRE(pairs.size() == 1);
      CHECK(pairs[0].offset_m.norm() == Approx(offset_m).epsilon(0.1));
      CHECK((pairs[0].offset_m - rotated(Vec2(offset_m, 0), angle_rad)).norm() < 0.1 * offset_m);
      CHECK(pairs[0].scatter_m < 0.003);
      CHECK(pairs[0].is_corrected);
      cameras.run(6, speed_mps, {0, 1});
      CHECK(cameras.corrected_disagreement_m(0, 1) < 0.001);
      // Which camera is right is unknown: each is corrected by half.
      CHECK(cameras.measured().correction_m(0).norm() == Approx(offset_m / 2).margin(0.001));
      CHECK(cameras.measured().correction_m(1).norm() == Approx(offset_m / 2).margin(0.001));
    }
  }
}

TEST_CASE("cameras that agree but for their noise are not corrected") {
  const double noise_m = GENERATE(0.0, 0.0015, 0.01);
  CAPTURE(noise_m);
  BiasedCameras cameras(4, {Vec2(0, 0), Vec2(0.001, 0)});
  cameras.noise_m = noise_m;
  cameras.run(120, 1, {0, 1});
  CHECK(cameras.measured().correction_m(0) == Vec2(0, 0));
  CHECK(cameras.measured().correction_m(1) == Vec2(0, 0));
  CHECK(cameras.measured().noise_m() == 0);
}

TEST_CASE("a few samples correct nothing, and corrections change slowly") {
  BiasedCameras cameras(5, {Vec2(0, 0), Vec2(0.04, 0)});
  cameras.run(0.1, 0, {0, 1});
  CHECK(cameras.measured().correction_m(1) == Vec2(0, 0));
  cameras.run(0.9, 0, {0, 1});
  CHECK(cameras.measured().correction_m(1).norm() > 0);
  CHECK(cameras.measured().correction_m(1).norm() <= CameraOffsets::kMaxChange_mps * 1.0 + 1e-9);
}

TEST_CASE("cameras in a row are corrected so that all agree") {
  BiasedCameras cameras(6, {Vec2(0.01, 0), Vec2(-0.02, 0.01), Vec2(0, 0.03)});
  for (int i = 0; i < 10; ++i) {
    cameras.run(2, 1, {0, 1});
    cameras.run(2, 1, {1, 2});
  }
  CHECK(cameras.corrected_disagreement_m(0, 1) < 0.002);
  CHECK(cameras.corrected_disagreement_m(1, 2) < 0.002);
  CHECK((cameras.measured().correction_m(0) + cameras.measured().correction_m(1) +
         cameras.measured().correction_m(2))
            .norm() < 1e-9);
}

TEST_CASE("a camera that disagrees with several others changes no faster") {
  BiasedCameras cameras(9, {Vec2(0.05, 0), Vec2(0, 0), Vec2(0, 0), Vec2(0, 0)});
  cameras.run(1, 0, {0, 1, 2, 3});
  CHECK(cameras.measured().correction_m(0).norm() > 0.5 * CameraOffsets::kMaxChange_mps);
  CHECK(cameras.measured().correction_m(0).norm() <= CameraOffsets::kMaxChange_mps * 1.0 + 1e-9);
}

TEST_CASE("cameras that never see the same robot are not compared") {
  BiasedCameras cameras(7, {Vec2(0, 0), Vec2(0.04, 0)});
  cameras.run(3, 1, {0});
  cameras.run(3, 1, {1});
  CHECK(cameras.measured().pairs().empty());
}

TEST_CASE("a camera that is moved is measured anew") {
  CameraOffsets measured({0, 1});
  Frame frame;
  Time now = kBegin;
  const auto run = [&](const Vec2& offset_m) {
    for (int i = 0; i < 600; ++i, now += kFrame) {
      for (const std::uint32_t camera : {0U, 1U}) {
        msg::DetectionFrame message = frame_message(camera, now);
        add_robot(message, 0, camera == 0 ? Vec2(1, 1) : Vec2(Vec2(1, 1) + offset_m));
        frame.assign(message, now);
        measured.add(frame);
      }
      measured.advance(kFrame);
    }
  };
  run({0.04, 0});
  CHECK(measured.pairs()[0].offset_m.x() == Approx(0.04));
  run({-0.02, 0});
  CHECK(measured.pairs()[0].offset_m.x() == Approx(-0.02));
  CHECK(measured.correction_m(1).x() == Approx(0.01).margin(0.001));
  // Cameras that are metres apart must be calibrated: they see another robot, or another floor.
  run({1, 0});
  CHECK(measured.pairs()[0].offset_m.x() == Approx(-0.02));
}

}  // namespace sidestep::camera_offsets_test
