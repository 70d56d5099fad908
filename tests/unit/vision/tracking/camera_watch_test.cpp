// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/camera_watch.hpp"

#include "tests/catch.hpp"

namespace sidestep::camera_watch_test {

using std::chrono::milliseconds;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

struct Fixture {
  CameraWatch watch;
  Time now = kBegin;

  explicit Fixture(std::uint32_t count) : watch(count) {}
  void frames(std::uint32_t camera, int count) {
    for (int i = 0; i < count; ++i) watch.on_frame(camera, now += milliseconds(17));
  }
  bool is_complete() const { return watch.is_complete(now); }
};

TEST_CASE("the floor is watched once every camera has sent some frames") {
  Fixture f(2);
  CHECK_FALSE(f.is_complete());
  f.frames(0, CameraWatch::kFrames + 5);
  CHECK_FALSE(f.is_complete());
  f.frames(1, CameraWatch::kFrames - 1);
  CHECK_FALSE(f.is_complete());
  f.frames(1, 1);
  CHECK(f.is_complete());
  f.watch.on_frame(77, f.now + milliseconds(1));  // no camera of this floor
  CHECK(f.is_complete());
}

TEST_CASE("after a gap a camera has to send some frames again") {
  Fixture f(1);
  f.frames(0, CameraWatch::kFrames);
  REQUIRE(f.is_complete());
  const Time last = f.now;
  CHECK(f.watch.is_complete(last + CameraWatch::kMaxAge));
  CHECK_FALSE(f.watch.is_complete(last + CameraWatch::kMaxAge + milliseconds(1)));
  SECTION("a short one does not count, nor does a frame that arrives late") {
    f.watch.on_frame(0, last - milliseconds(500));
    f.watch.on_frame(0, f.now = last + CameraWatch::kMaxGap);
    CHECK(f.is_complete());
  }
  SECTION("a long one") {
    f.watch.on_frame(0, f.now = last + CameraWatch::kMaxGap + milliseconds(1));
    CHECK_FALSE(f.is_complete());
    f.frames(0, CameraWatch::kFrames - 1);
    CHECK(f.is_complete());
  }
}

TEST_CASE("if the number of cameras is not known, those count that are heard") {
  Fixture f(0);
  CHECK_FALSE(f.is_complete());
  f.frames(3, CameraWatch::kFrames);
  CHECK(f.is_complete());
  f.frames(8, 1);
  CHECK_FALSE(f.is_complete());
  f.frames(8, CameraWatch::kFrames);
  CHECK(f.is_complete());
  // Camera 3 falls silent, and is forgotten in the end.
  f.frames(8, 45);
  CHECK_FALSE(f.is_complete());
  f.frames(8, 90);
  CHECK(f.is_complete());
}

}  // namespace sidestep::camera_watch_test
