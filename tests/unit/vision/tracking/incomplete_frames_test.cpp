// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/incomplete_frames.hpp"

#include "tests/catch.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::incomplete_frames_test {

using namespace sidestep::test;

TEST_CASE(
    "an incomplete frame's distance shrinks by obstacle motion, errors of position and date, and the "
    "distance "
    "between robots") {
  const std::uint64_t seed = GENERATE(range(1u, 21u));
  CAPTURE(seed);
  Rng rng(seed);
  const double speed_mps = rng.uniform(0, 2), error_m = rng.uniform(0, 0.2);
  IncompleteFrames frames(speed_mps, error_m, from_seconds(1));
  msg::DetectionFrame message = frame_message(0, kBegin);
  add_robot(message, 0, {0, 0});
  Frame frame;
  const double date_error_s = rng.uniform(0, 0.015);
  frame.assign(message, kBegin, kMaxFrameLead, from_seconds(date_error_s));
  const double within_m = rng.uniform(0.5, 3);
  frames.update(frame, within_m);
  const double age_s = rng.uniform(0, 0.9), away_m = rng.uniform(0, 0.5);
  const std::vector<Vec2> robots_m{{0, 0}, {0, away_m}};
  const Time t = kBegin + from_seconds(age_s);
  CHECK(frames.complete_within_m(robots_m, t) ==
        Approx(std::max(0.0, within_m - error_m - speed_mps * (age_s + date_error_s) - away_m)).margin(1e-6));
  CHECK(frames.complete_within_m({}, t) == 0);
  CHECK(frames.complete_within_m(robots_m, kBegin + from_seconds(1.1)) == kCompleteEverywhere_m);
}

}  // namespace sidestep::incomplete_frames_test
