// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/motion_predictor.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

#include "agents/navigation/trapezoid.hpp"
#include "common/random/rng.hpp"

using namespace sidestep;

namespace {

constexpr MotionLimits kLimits;
constexpr double kStep_s = batch::kPredictionStep_s;
constexpr std::size_t kSteps = batch::kPredictionSteps;

struct Course {
  State state;
  Intent intent;
};

Vec2 random_place(Rng& rng, double far_m) {
  const double x = rng.uniform(-far_m, far_m);
  return {x, rng.uniform(-far_m, far_m)};
}

Course random_course(Rng& rng) {
  Course course;
  course.state.position_m = random_place(rng, 3);
  course.state.velocity_mps = random_place(rng, 1.4);
  course.intent.velocity_mps = random_place(rng, 1.4);
  course.intent.hold_s = rng.chance(0.3) ? 0 : rng.uniform(0, 2);
  course.intent.goal_m = random_place(rng, 3);
  course.intent.waypoint_m = rng.chance(0.5) ? course.intent.goal_m : random_place(rng, 3);
  return course;
}

/// The same drive, written for one robot.
std::vector<Vec2> slowly_driven(const Course& course) {
  const Intent& intent = course.intent;
  const double leg = (intent.goal_m - intent.waypoint_m).norm();
  bool is_past = leg < 1e-9;
  Vec2 p = course.state.position_m, v = course.state.velocity_mps;
  std::vector<Vec2> places{p};
  for (std::size_t i = 0; i < kSteps; ++i) {
    Vec2 desired = intent.velocity_mps;
    if (intent.hold_s - static_cast<double>(i) * kStep_s <= 1e-9) {
      is_past = is_past || (intent.waypoint_m - p).norm() < 0.2;
      const Vec2 to_go = (is_past ? intent.goal_m : intent.waypoint_m) - p;
      const double rest = to_go.norm() + (is_past ? 0 : leg);
      const double brakes =
          std::sqrt(1.6 * kLimits.deceleration_mps2 * rest) - kLimits.deceleration_mps2 * kStep_s / 2;
      const double creep = std::min(rest / kStep_s, 0.5);
      desired = std::min(kLimits.speed_mps, std::max(brakes, creep)) * to_go.stableNormalized();
    }
    const bool slows = desired.squaredNorm() < 0.9 * v.squaredNorm();
    const double most = kStep_s * (slows ? kLimits.deceleration_mps2 : kLimits.acceleration_mps2);
    Vec2 change = desired - v;
    if (change.norm() > most) change *= most / change.norm();
    p += kStep_s * (v + 0.5 * change);
    v += change;
    places.push_back(p);
  }
  return places;
}

}  // namespace

TEST_CASE("robots are driven in thought as one by one with every instruction set") {
  const std::uint64_t seed = 7;
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Course> courses;
  for (int i = 0; i < 203; ++i) courses.push_back(random_course(rng));
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    CAPTURE(kernels.name);
    MotionPredictor forecasts(kLimits, kernels);
    for (const Course& course : courses) forecasts.add(course.state, course.intent);
    forecasts.drive();
    REQUIRE(forecasts.size() == courses.size());
    for (std::size_t lane = 0; lane < courses.size(); ++lane) {
      CAPTURE(lane);
      const batch::Prediction forecast = forecasts.of(lane);
      const std::vector<Vec2> places = slowly_driven(courses[lane]);
      for (std::size_t i = 0; i <= kSteps; ++i) {
        REQUIRE(forecast.x_m[i] == Approx(places[i].x()).margin(1e-4));
        REQUIRE(forecast.y_m[i] == Approx(places[i].y()).margin(1e-4));
      }
    }
  }
}

TEST_CASE("every instruction set forecasts the same to the last bit") {
  const std::uint64_t seed = 8;
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Course> courses;
  for (int i = 0; i < 1000; ++i) courses.push_back(random_course(rng));
  std::vector<double> first;
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    CAPTURE(kernels.name);
    MotionPredictor forecasts(kLimits, kernels);
    for (const Course& course : courses) forecasts.add(course.state, course.intent);
    forecasts.drive();
    const std::vector<float> weights(batch::kPredictionSamples, 0.5F);
    std::vector<batch::PredictionRow> dangers(forecasts.block_count(), batch::PredictionRow{});
    const batch::Prediction one = forecasts.of(3);
    kernels.forecasting.meet(one, 0, 0.5F, weights.data(), 0.3F, forecasts.blocks(), forecasts.block_count(),
                             dangers.data());
    kernels.forecasting.leave(2, 2, 0.1F, weights.data(), forecasts.blocks(), forecasts.block_count(),
                              dangers.data());
    std::vector<double> all;
    for (std::size_t lane = 0; lane < forecasts.size(); ++lane) {
      const batch::Prediction forecast = forecasts.of(lane);
      all.insert(all.end(), std::begin(forecast.x_m), std::end(forecast.x_m));
      all.insert(all.end(), std::begin(forecast.y_m), std::end(forecast.y_m));
      all.push_back(forecasts.arrival_s(lane));
      all.push_back(dangers[lane / batch::kPredictionLanes].lane[lane % batch::kPredictionLanes]);
    }
    if (first.empty()) first = all;
    REQUIRE(std::memcmp(first.data(), all.data(), all.size() * sizeof(double)) == 0);
  }
}

TEST_CASE("a robot is expected at its goal about when it gets there") {
  const std::uint64_t seed = 9;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    const Vec2 goal = random_place(rng, 3);
    const double fastest_s = Trapezoid2d(goal, {0, 0}, kLimits).along().duration_s();
    MotionPredictor forecasts(kLimits);
    forecasts.add({}, {{0, 0}, 0, goal, goal});
    forecasts.drive();
    CAPTURE(goal.x(), goal.y());
    REQUIRE(forecasts.arrival_s(0) > fastest_s - 0.05);
    REQUIRE(forecasts.arrival_s(0) < fastest_s + 0.15);
  }
}

TEST_CASE("there is danger where two come nearer than they shall and only there") {
  const std::uint64_t seed = 10;
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<float> weights(batch::kPredictionSamples, 1.0F);
  int dangerous = 0;
  for (int round = 0; round < 300; ++round) {
    MotionPredictor forecasts(kLimits);
    for (int i = 0; i < 9; ++i) forecasts.add(random_course(rng).state, random_course(rng).intent);
    forecasts.drive();
    const float min_separation_m = static_cast<float>(rng.uniform(0.1, 1));
    const batch::Prediction one = forecasts.of(8);
    std::vector<batch::PredictionRow> dangers(forecasts.block_count(), batch::PredictionRow{});
    batch::best_kernels().forecasting.meet(one, 0, min_separation_m, weights.data(), 1e9F, forecasts.blocks(),
                                           forecasts.block_count(), dangers.data());
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const batch::Prediction other = forecasts.of(lane);
      double nearest = 1e9;
      for (std::size_t i = 0; i < kSteps; ++i) {
        for (double share = 0; share <= 1; share += 0.002) {
          const auto at = [&](const float* p) { return p[i] + share * (p[i + 1] - p[i]); };
          nearest = std::min(nearest, std::hypot(at(one.x_m) - at(other.x_m), at(one.y_m) - at(other.y_m)));
        }
      }
      const double danger = dangers[lane / batch::kPredictionLanes].lane[lane % batch::kPredictionLanes];
      CAPTURE(round, lane, nearest, min_separation_m, danger);
      if (nearest < min_separation_m - 1e-3) REQUIRE(danger > 0);
      if (nearest > min_separation_m + 1e-3) REQUIRE(danger == 0);
      dangerous += danger > 0;
    }
  }
  CHECK(dangerous > 200);
}
