// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/camera_watch.hpp"

#include "tests/catch.hpp"

namespace sidestep::camera_watch_test {

using std::chrono::milliseconds;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

struct Fixture {
  CameraWatch watch;
  Time now = kBegin;

  explicit Fixture(const std::vector<std::uint32_t>& cameras) : watch(cameras) {}
  void frames(std::uint32_t camera, int count) {
    for (int i = 0; i < count; ++i) watch.on_frame(camera, now += milliseconds(17));
  }
  bool is_complete() const { return watch.is_complete(now); }
};

TEST_CASE("the floor is watched once every camera has sent some frames") {
  Fixture f({0, 1});
  CHECK_FALSE(f.is_complete());
  f.frames(0, CameraWatch::kFrames + 5);
  CHECK_FALSE(f.is_complete());
  f.frames(1, CameraWatch::kFrames - 1);
  CHECK_FALSE(f.is_complete());
  f.frames(1, 1);
  CHECK(f.is_complete());
  CHECK_FALSE(f.watch.has(77));
}

TEST_CASE("after a gap, a camera must send some frames again") {
  Fixture f({0});
  f.frames(0, CameraWatch::kFrames);
  REQUIRE(f.is_complete());
  const Time last = f.now;
  CHECK(f.watch.is_complete(last + CameraWatch::kMaxAge));
  CHECK_FALSE(f.watch.is_complete(last + CameraWatch::kMaxAge + milliseconds(1)));
  SECTION("a camera watches without a pause after a short gap or a late frame") {
    f.watch.on_frame(0, last - milliseconds(500));
    f.watch.on_frame(0, f.now = last + CameraWatch::kMaxGap);
    CHECK(f.is_complete());
  }
  SECTION("a camera does not watch immediately after a long gap") {
    f.watch.on_frame(0, f.now = last + CameraWatch::kMaxGap + milliseconds(1));
    CHECK_FALSE(f.is_complete());
    f.frames(0, CameraWatch::kFrames - 1);
    CHECK(f.is_complete());
  }
}

TEST_CASE("the floor is not watched while a camera is silent, even for several minutes") {
  Fixture f({3, 8});
  f.frames(3, CameraWatch::kFrames);
  f.frames(8, CameraWatch::kFrames);
  REQUIRE(f.is_complete());
  // Camera 3 fails.
  f.frames(8, 35);
  bool was_complete = false;
  for (int i = 0; i < 10'000; ++i) {
    f.frames(8, 1);
    was_complete |= f.is_complete();
  }
  CHECK_FALSE(was_complete);
  f.frames(3, CameraWatch::kFrames);
  f.frames(8, 1);
  CHECK(f.is_complete());
}

TEST_CASE("a floor is not watched if it has no cameras or if one of its cameras was never heard") {
  Fixture none({});
  CHECK_FALSE(none.is_complete());
  Fixture f({3, 8});
  f.frames(8, 10'000);
  CHECK_FALSE(f.is_complete());
}

}  // namespace sidestep::camera_watch_test
