// SPDX-License-Identifier: Apache-2.0
#include "common/marking/pose_error.hpp"

#include <Eigen/Dense>

#include "common/marking/butterfly.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/marking/random_layout.hpp"
#include "tests/unit/common/random/normal_vector.hpp"

namespace sidestep::pose_error_test {

struct Fit {
  Vec2 position_m;
  double heading_rad;
};

/// The least-squares pose by the Kabsch algorithm (singular value decomposition).
Fit fitted(const std::vector<Vec2>& model, const std::vector<Vec2>& measured) {
  Vec2 model_mean(0, 0), measured_mean(0, 0);
  for (std::size_t i = 0; i < model.size(); ++i) model_mean += model[i], measured_mean += measured[i];
  model_mean /= static_cast<double>(model.size());
  measured_mean /= static_cast<double>(model.size());
  Eigen::Matrix2d product = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < model.size(); ++i)
    product += (model[i] - model_mean) * (measured[i] - measured_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix2d rotation = svd.matrixV() * svd.matrixU().transpose();
  if (rotation.determinant() < 0)
    rotation = svd.matrixV() * Eigen::Vector2d(1, -1).asDiagonal() * svd.matrixU().transpose();
  return {measured_mean - rotation * model_mean, std::atan2(rotation(1, 0), rotation(0, 0))};
}

struct SampledError {
  double longitudinal_m = 0, lateral_m = 0, heading_rad = 0;
};

SampledError sampled_error(const MarkerLayout& layout, double sd_m, Rng& rng) {
  std::vector<Vec2> model{layout.centre.position_m};
  for (const Marker& dot : layout.dots) model.push_back(dot.position_m);
  constexpr int kTrials = 40000;
  SampledError sum;
  for (int i = 0; i < kTrials; ++i) {
    const double heading_rad = rng.uniform(-3, 3);
    const double y = rng.uniform(-5, 5), x = rng.uniform(-5, 5);
    const Vec2 position_m(x, y);
    std::vector<Vec2> measured;
    for (const Vec2& p : model) {
      measured.push_back(position_m + rotated(p, heading_rad) + sd_m * normal_vector(rng));
    }
    const Fit fit = fitted(model, measured);
    const Vec2 error_m = rotated(fit.position_m - position_m, -heading_rad);
    sum.longitudinal_m += error_m.x() * error_m.x();
    sum.lateral_m += error_m.y() * error_m.y();
    sum.heading_rad += std::pow(wrapped_rad(fit.heading_rad - heading_rad), 2);
  }
  return {std::sqrt(sum.longitudinal_m / kTrials), std::sqrt(sum.lateral_m / kTrials),
          std::sqrt(sum.heading_rad / kTrials)};
}

void compare(const MarkerLayout& layout, Rng& rng) {
  for (const double sd_m : {0.0002, 0.001}) {
    const PoseError predicted = predicted_pose_error(layout, sd_m);
    const SampledError sampled = sampled_error(layout, sd_m, rng);
    CAPTURE(layout.dots.size(), sd_m);
    // Four standard errors of a standard deviation estimated from 40,000 trials are 1.4 %.
    CHECK(sampled.longitudinal_m == Approx(predicted.longitudinal_m).epsilon(0.015));
    CHECK(sampled.lateral_m == Approx(predicted.lateral_m).epsilon(0.015));
    CHECK(sampled.heading_rad == Approx(predicted.heading_rad).epsilon(0.015));
  }
}

TEST_CASE("sampled pose errors match the prediction") {
  const std::uint64_t seed = 31;
  CAPTURE(seed);
  Rng rng(seed);
  compare(butterfly(), rng);
  compare(random_rings(3, 1, rng), rng);
  MarkerLayout lopsided;  // its centroid is far from its origin
  lopsided.centre = {{0.05, 0.04}, 0.02};
  lopsided.dots = {{{0.09, 0.03}, 0.01}, {{0.06, 0.09}, 0.01}};
  compare(lopsided, rng);
}

TEST_CASE("the butterfly's predicted error matches the closed form") {
  const PoseError error = predicted_pose_error(butterfly(), 0.001);
  CHECK(error.centroid_m == Approx(0.001 / std::sqrt(5.0)));
  CHECK(error.longitudinal_m == Approx(error.centroid_m));
  // Four dots are 65 mm from the origin, and the centroid is 7.91 mm behind it.
  const double centroid_m = 2 * (0.035 - 0.054772) / 5,
               sum_of_squares_m2 = 4 * 0.065 * 0.065 - 5 * centroid_m * centroid_m;
  CHECK(error.heading_rad == Approx(0.001 / std::sqrt(sum_of_squares_m2)).epsilon(1e-4));
  CHECK(error.lateral_m > error.longitudinal_m);
}

}  // namespace sidestep::pose_error_test
