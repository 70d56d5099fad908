// SPDX-License-Identifier: Apache-2.0
#include "common/marking/pose_error.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "common/marking/butterfly.hpp"
#include "common/random/rng.hpp"
#include "tests/unit/common/marking/random_layout.hpp"

using namespace sidestep;

namespace {

struct Fit {
  Vec2 position_m;
  double heading_rad;
};

/// The pose that minimises the squared distances, by Kabsch's singular value decomposition.
Fit fitted(const std::vector<Vec2>& model, const std::vector<Vec2>& seen) {
  Vec2 model_mean(0, 0), seen_mean(0, 0);
  for (std::size_t i = 0; i < model.size(); ++i) model_mean += model[i], seen_mean += seen[i];
  model_mean /= static_cast<double>(model.size());
  seen_mean /= static_cast<double>(model.size());
  Eigen::Matrix2d product = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < model.size(); ++i)
    product += (model[i] - model_mean) * (seen[i] - seen_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix2d turn = svd.matrixV() * svd.matrixU().transpose();
  if (turn.determinant() < 0)
    turn = svd.matrixV() * Eigen::Vector2d(1, -1).asDiagonal() * svd.matrixU().transpose();
  return {seen_mean - turn * model_mean, std::atan2(turn(1, 0), turn(0, 0))};
}

struct Measured {
  double ahead_m = 0, aside_m = 0, heading_rad = 0;
};

Measured measured(const MarkingLayout& layout, double sd_m, Rng& rng) {
  std::vector<Vec2> model{layout.centre.position_m};
  for (const MarkingDot& dot : layout.dots) model.push_back(dot.position_m);
  constexpr int kTrials = 40000;
  Measured sum;
  for (int i = 0; i < kTrials; ++i) {
    const double heading_rad = rng.uniform(-3, 3);
    const Vec2 place_m(rng.uniform(-5, 5), rng.uniform(-5, 5));
    std::vector<Vec2> seen;
    for (const Vec2& p : model) {
      const Vec2 error(rng.normal(), rng.normal());
      seen.push_back(place_m + rotated(p, heading_rad) + sd_m * error);
    }
    const Fit fit = fitted(model, seen);
    const Vec2 off = rotated(fit.position_m - place_m, -heading_rad);
    sum.ahead_m += off.x() * off.x();
    sum.aside_m += off.y() * off.y();
    sum.heading_rad += std::pow(wrapped_rad(fit.heading_rad - heading_rad), 2);
  }
  return {std::sqrt(sum.ahead_m / kTrials), std::sqrt(sum.aside_m / kTrials),
          std::sqrt(sum.heading_rad / kTrials)};
}

void compare(const MarkingLayout& layout, Rng& rng) {
  for (const double sd_m : {0.0002, 0.001}) {
    const PoseError predicted = predicted_pose_error(layout, sd_m);
    const Measured real = measured(layout, sd_m, rng);
    CAPTURE(layout.dots.size(), sd_m);
    // Four standard deviations of a standard deviation over 40,000 trials are 1.4 percent.
    CHECK(real.ahead_m == Approx(predicted.ahead_m).epsilon(0.015));
    CHECK(real.aside_m == Approx(predicted.aside_m).epsilon(0.015));
    CHECK(real.heading_rad == Approx(predicted.heading_rad).epsilon(0.015));
  }
}

}  // namespace

TEST_CASE("the error of a pose is what the layout predicts") {
  const std::uint64_t seed = 31;
  CAPTURE(seed);
  Rng rng(seed);
  compare(butterfly(), rng);
  compare(random_rings(3, 1, rng), rng);
  MarkingLayout lopsided;  // its centroid is far from the origin
  lopsided.centre = {{0.05, 0.04}, 0.02};
  lopsided.dots = {{{0.09, 0.03}, 0.01}, {{0.06, 0.09}, 0.01}};
  compare(lopsided, rng);
}

TEST_CASE("the butterfly's error is known") {
  const PoseError error = predicted_pose_error(butterfly(), 0.001);
  CHECK(error.centroid_m == Approx(0.001 / std::sqrt(5.0)));
  CHECK(error.ahead_m == Approx(error.centroid_m));
  // Four dots 65 mm from the origin; the centroid lies 7.91 mm behind it.
  const double centroid_m = 2 * (0.035 - 0.054772) / 5,
               squares_m2 = 4 * 0.065 * 0.065 - 5 * centroid_m * centroid_m;
  CHECK(error.heading_rad == Approx(0.001 / std::sqrt(squares_m2)).epsilon(1e-4));
  CHECK(error.aside_m > error.ahead_m);
}
