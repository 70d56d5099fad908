// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/path_recorder.hpp"

#include <random>

#include "tests/catch.hpp"

namespace sidestep::path_recorder_test {

using Point = PathRecorder::Point;

Point at(double seconds, const Vec2& position_m, double speed_mps = 1) {
  return {time_from_ns(1'000'000'000) + from_seconds(seconds), position_m, speed_mps};
}

/// Where the recorded path is at the time of a point: on the straight line between two of its points.
Vec2 position_on(const std::vector<Point>& path, Time when) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (path[i].at < when) continue;
    const double share = to_seconds(when - path[i - 1].at) / to_seconds(path[i].at - path[i - 1].at);
    return path[i - 1].position_m + share * (path[i].position_m - path[i - 1].position_m);
  }
  return path.back().position_m;
}

TEST_CASE("even motion and rest are recorded as their ends") {
  PathRecorder recorder(1000);
  for (int i = 0; i <= 100; ++i) recorder.add(at(0.1 * i, {0.1 * i, 0}));
  for (int i = 1; i <= 100; ++i) recorder.add(at(10 + 0.1 * i, {10, 0}, 0));
  const std::vector<Point> points = recorder.points();
  // The robot stops within one period, at whose two ends there is a point each.
  CHECK(points.size() == 4);
  CHECK(points.front().position_m == Vec2(0, 0));
  CHECK(points.back().at == at(20, Vec2(0, 0)).at);
  CHECK(points.back().speed_mps == 0);
}

TEST_CASE("between its points, a recorded path is within a centimetre of the robot") {
  const auto seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> turn(-0.3, 0.3);
  PathRecorder recorder(1000);
  std::vector<Point> driven;
  Vec2 position_m(0, 0);
  double heading_rad = 0;
  for (int i = 0; i < 600; ++i) {
    heading_rad += turn(random);
    position_m += 0.05 * Vec2(std::cos(heading_rad), std::sin(heading_rad));
    driven.push_back(at(0.051 * i, position_m));
    recorder.add(driven.back());
  }
  const std::vector<Point> points = recorder.points();
  CHECK(points.size() < driven.size());
  for (const Point& point : driven) CHECK((position_on(points, point.at) - point.position_m).norm() < 0.0101);
}

TEST_CASE("a full recorder keeps the whole run with fewer points, and its end") {
  PathRecorder recorder(100);
  const int last = GENERATE(5000, 5001, 5002, 5003);
  for (int i = 0; i <= last; ++i) recorder.add(at(0.05 * i, {i % 2 ? 1.0 : 0.0, 0.05 * i}));
  const std::vector<Point> points = recorder.points();
  CHECK(points.size() <= 101);
  CHECK(points.front().at == at(0, Vec2(0, 0)).at);
  CHECK(points.back().at == at(0.05 * last, Vec2(0, 0)).at);
}

TEST_CASE("points that are not later than the last one are ignored") {
  PathRecorder recorder(10);
  recorder.add(at(1, {1, 1}));
  recorder.add(at(0, {0, 0}));
  recorder.add(at(1, {2, 2}));
  REQUIRE(recorder.latest());
  CHECK(recorder.latest()->position_m == Vec2(1, 1));
  CHECK(recorder.points().size() == 1);
  CHECK_FALSE(PathRecorder(10).latest());
}

}  // namespace sidestep::path_recorder_test
