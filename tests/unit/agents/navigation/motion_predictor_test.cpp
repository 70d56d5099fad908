// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/motion_predictor.hpp"

#include <algorithm>
#include <cstring>

#include "agents/navigation/trapezoidal_profile.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::motion_predictor_test {

constexpr MotionLimits kLimits;
constexpr double kStep_s = batch::kPredictionStep_s;
constexpr std::size_t kSteps = batch::kPredictionSteps;

struct Course {
  State state;
  Intent intent;
};

Vec2 random_position(Rng& rng, double half_m) {
  const double x = rng.uniform(-half_m, half_m);
  return {x, rng.uniform(-half_m, half_m)};
}

Course random_course(Rng& rng) {
  Course course;
  course.state.position_m = random_position(rng, 3);
  course.state.velocity_mps = random_position(rng, 1.4);
  course.intent.velocity_mps = random_position(rng, 1.4);
  course.intent.velocity_duration_s = rng.chance(0.3) ? 0 : rng.uniform(0, 2);
  course.intent.goal_m = random_position(rng, 3);
  course.intent.waypoint_m = rng.chance(0.5) ? course.intent.goal_m : random_position(rng, 3);
  return course;
}

/// Scalar reference: predicts the motion of one robot.
std::vector<Vec2> reference_prediction(const Course& course) {
  const Intent& intent = course.intent;
  const double leg = (intent.goal_m - intent.waypoint_m).norm();
  bool is_past_waypoint = leg < 1e-9;
  Vec2 p = course.state.position_m, v = course.state.velocity_mps;
  std::vector<Vec2> positions{p};
  for (std::size_t i = 0; i < kSteps; ++i) {
    Vec2 desired = intent.velocity_mps;
    if (intent.velocity_duration_s - static_cast<double>(i) * kStep_s <= 1e-9) {
      is_past_waypoint = is_past_waypoint || (intent.waypoint_m - p).norm() < 0.2;
      const Vec2 to_target = (is_past_waypoint ? intent.goal_m : intent.waypoint_m) - p;
      const double remaining_m = to_target.norm() + (is_past_waypoint ? 0 : leg);
      const double braking_mps =
          std::sqrt(1.6 * kLimits.deceleration_mps2 * remaining_m) - kLimits.deceleration_mps2 * kStep_s / 2;
      const double creep_mps = std::min(remaining_m / kStep_s, 0.5);
      desired = std::min(kLimits.speed_mps, std::max(braking_mps, creep_mps)) * to_target.stableNormalized();
    }
    const bool slows = desired.squaredNorm() < 0.9 * v.squaredNorm();
    const double max_change_mps = kStep_s * (slows ? kLimits.deceleration_mps2 : kLimits.acceleration_mps2);
    Vec2 change = desired - v;
    if (change.norm() > max_change_mps) change *= max_change_mps / change.norm();
    p += kStep_s * (v + 0.5 * change);
    v += change;
    positions.push_back(p);
  }
  return positions;
}

TEST_CASE("every instruction set agrees with the scalar reference") {
  const std::uint64_t seed = 7;
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Course> courses;
  for (int i = 0; i < 203; ++i) courses.push_back(random_course(rng));
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    CAPTURE(kernels.name);
    MotionPredictor predictor(kLimits, kernels);
    for (const Course& course : courses) predictor.add(course.state, course.intent);
    predictor.predict();
    REQUIRE(predictor.size() == courses.size());
    for (std::size_t lane = 0; lane < courses.size(); ++lane) {
      CAPTURE(lane);
      const batch::Prediction prediction = predictor.prediction_of(lane);
      const std::vector<Vec2> positions = reference_prediction(courses[lane]);
      for (std::size_t i = 0; i <= kSteps; ++i) {
        REQUIRE(prediction.x_m[i] == Approx(positions[i].x()).margin(1e-4));
        REQUIRE(prediction.y_m[i] == Approx(positions[i].y()).margin(1e-4));
      }
    }
  }
}

TEST_CASE("every instruction set gives bit-identical predictions") {
  const std::uint64_t seed = 8;
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Course> courses;
  for (int i = 0; i < 1000; ++i) courses.push_back(random_course(rng));
  std::vector<double> first;
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    CAPTURE(kernels.name);
    MotionPredictor predictor(kLimits, kernels);
    for (const Course& course : courses) predictor.add(course.state, course.intent);
    predictor.predict();
    const std::vector<float> weights(batch::kPredictionSamples, 0.5F);
    std::vector<batch::PredictionRow> dangers(predictor.block_count(), batch::PredictionRow{});
    const batch::Prediction reference = predictor.prediction_of(3);
    kernels.prediction.add_proximity_danger(reference, 0, 0.5F, weights.data(), 0.3F, predictor.blocks(),
                                            predictor.block_count(), dangers.data());
    kernels.prediction.add_outside_danger(2, 2, 0.1F, weights.data(), predictor.blocks(),
                                          predictor.block_count(), dangers.data());
    std::vector<double> all;
    for (std::size_t lane = 0; lane < predictor.size(); ++lane) {
      const batch::Prediction prediction = predictor.prediction_of(lane);
      all.insert(all.end(), std::begin(prediction.x_m), std::end(prediction.x_m));
      all.insert(all.end(), std::begin(prediction.y_m), std::end(prediction.y_m));
      all.push_back(predictor.arrival_s(lane));
      all.push_back(dangers[lane / batch::kPredictionLanes].lane[lane % batch::kPredictionLanes]);
    }
    if (first.empty()) first = all;
    REQUIRE(std::memcmp(first.data(), all.data(), all.size() * sizeof(double)) == 0);
  }
}

TEST_CASE("predicted arrival times agree with time-optimal motion") {
  const std::uint64_t seed = 9;
  CAPTURE(seed);
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    const Vec2 goal = random_position(rng, 3);
    const double fastest_s = TrapezoidalProfile2d(goal, {0, 0}, kLimits).along().duration_s();
    MotionPredictor predictor(kLimits);
    predictor.add({}, {{0, 0}, 0, goal, goal});
    predictor.predict();
    CAPTURE(goal.x(), goal.y());
    REQUIRE(predictor.arrival_s(0) > fastest_s - 0.05);
    REQUIRE(predictor.arrival_s(0) < fastest_s + 0.15);
  }
}

TEST_CASE("danger is positive exactly if two robots come nearer than their minimum separation") {
  const std::uint64_t seed = 10;
  CAPTURE(seed);
  Rng rng(seed);
  const std::vector<float> weights(batch::kPredictionSamples, 1.0F);
  int dangerous = 0;
  for (int round = 0; round < 300; ++round) {
    MotionPredictor predictor(kLimits);
    for (int i = 0; i < 9; ++i) {
      const Intent intent = random_course(rng).intent;
      predictor.add(random_course(rng).state, intent);
    }
    predictor.predict();
    const float min_separation_m = static_cast<float>(rng.uniform(0.1, 1));
    const batch::Prediction reference = predictor.prediction_of(8);
    std::vector<batch::PredictionRow> dangers(predictor.block_count(), batch::PredictionRow{});
    batch::best_kernels().prediction.add_proximity_danger(reference, 0, min_separation_m, weights.data(),
                                                          1e9F, predictor.blocks(), predictor.block_count(),
                                                          dangers.data());
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const batch::Prediction other = predictor.prediction_of(lane);
      double nearest = 1e9;
      for (std::size_t i = 0; i < kSteps; ++i) {
        for (double share = 0; share <= 1; share += 0.002) {
          const auto at = [&](const float* p) { return p[i] + share * (p[i + 1] - p[i]); };
          nearest = std::min(
              nearest, std::hypot(at(reference.x_m) - at(other.x_m), at(reference.y_m) - at(other.y_m)));
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

}  // namespace sidestep::motion_predictor_test
