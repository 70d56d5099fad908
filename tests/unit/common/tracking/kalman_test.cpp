// SPDX-License-Identifier: Apache-2.0
#include "common/tracking/kalman.hpp"

#include <Eigen/Dense>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/random/normal_vector.hpp"

namespace sidestep::kalman_test {

constexpr double kAccelerationPsd = 0.3;
constexpr double kNoise_m = 0.0015;
using Filter1 = ConstantVelocityFilter<1>;
using Filter2 = ConstantVelocityFilter<2>;

Eigen::Matrix2d transition(double dt_s) { return (Eigen::Matrix2d() << 1, dt_s, 0, 1).finished(); }

Eigen::Matrix2d white_noise(double dt_s) {
  return kAccelerationPsd *
         (Eigen::Matrix2d() << dt_s * dt_s * dt_s / 3, dt_s * dt_s / 2, dt_s * dt_s / 2, dt_s).finished();
}

/// (position, velocity) of one axis after a random step of the model.
Eigen::Vector2d stepped(const Eigen::Vector2d& x, double dt_s, Rng& rng) {
  const Eigen::Matrix2d root = white_noise(dt_s).llt().matrixL();
  return transition(dt_s) * x + root * normal_vector(rng);
}

TEST_CASE("the filter's errors match its covariance") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  constexpr int kRuns = 2000;
  double squared_error = 0;
  for (int run = 0; run < kRuns; ++run) {
    Eigen::Vector2d truth[2];
    for (auto& axis : truth) axis = {rng.normal() * kNoise_m, rng.normal() * 1.5};
    Filter2 filter(Eigen::Vector2d::Zero(), kNoise_m * kNoise_m, 1.5 * 1.5);
    for (int step = 0; step < 20; ++step) {
      const double dt_s = rng.uniform(0.002, 0.04);
      for (auto& axis : truth) axis = stepped(axis, dt_s, rng);
      filter.predict(dt_s, {kAccelerationPsd, 0});
      const Eigen::Vector2d measured{truth[0](0) + kNoise_m * rng.normal(),
                                     truth[1](0) + kNoise_m * rng.normal()};
      filter.correct(measured - filter.position(), kNoise_m * kNoise_m);
    }
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d error = Eigen::Vector2d(filter.position()(i), filter.velocity()(i)) - truth[i];
      squared_error += error.dot(filter.covariance().inverse() * error);
    }
  }
  // Chi-squared with 4 degrees of freedom: mean 4, variance 8. Margin: five standard deviations of the mean
  // over all runs.
  CHECK(squared_error / kRuns == Approx(4).margin(5 * std::sqrt(8.0 / kRuns)));
}

TEST_CASE("the filter's estimate equals batch least squares over all observations") {
  const std::uint64_t seed = GENERATE(11u, 12u, 13u, 14u);
  CAPTURE(seed);
  Rng rng(seed);
  constexpr int kSteps = 12;
  // Joint covariance of the positions at all steps and the last state, from the model alone.
  std::vector<double> gaps(kSteps);
  for (double& gap : gaps) gap = rng.uniform(0.001, 0.1);
  std::vector<Eigen::Matrix2d> prior{Eigen::Vector2d(kNoise_m * kNoise_m, 2.25).asDiagonal()};
  for (double gap : gaps) {
    prior.push_back(transition(gap) * prior.back() * transition(gap).transpose() + white_noise(gap));
  }
  Eigen::MatrixXd measured_covariance = Eigen::MatrixXd::Identity(kSteps, kSteps) * kNoise_m * kNoise_m;
  Eigen::MatrixXd last_measured(2, kSteps);
  for (int i = 0; i < kSteps; ++i) {
    Eigen::Matrix2d joint = prior[static_cast<std::size_t>(i + 1)];
    for (int j = i; j < kSteps; ++j) {
      if (j > i) joint = transition(gaps[static_cast<std::size_t>(j)]) * joint;
      measured_covariance(i, j) += joint(0, 0);
      if (j > i) measured_covariance(j, i) += joint(0, 0);
      if (j == kSteps - 1) last_measured.col(i) = joint.col(0);
    }
  }
  Eigen::VectorXd measured(kSteps);
  for (int i = 0; i < kSteps; ++i) measured(i) = rng.uniform(-0.01, 0.01);
  const Eigen::Vector2d expected = last_measured * measured_covariance.ldlt().solve(measured);
  const Eigen::Matrix2d covariance =
      prior.back() -
      last_measured * measured_covariance.ldlt().solve(Eigen::MatrixXd(last_measured.transpose()));

  Filter1 filter(Filter1::Vector(0), kNoise_m * kNoise_m, 2.25);
  for (int i = 0; i < kSteps; ++i) {
    filter.predict(gaps[static_cast<std::size_t>(i)], {kAccelerationPsd, 0});
    filter.correct(Filter1::Vector(measured(i)) - filter.position(), kNoise_m * kNoise_m);
  }
  CHECK(filter.position()(0) == Approx(expected(0)).margin(1e-9));
  CHECK(filter.velocity()(0) == Approx(expected(1)).margin(1e-7));
  CHECK((filter.covariance() - covariance).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("a rolling ball is predicted to come to rest and stay there") {
  Eigen::Vector2d position{0, 0}, velocity{0.6, -0.8};
  // Two exact observations, a millisecond apart, determine the filter's velocity.
  Filter2 rolling(position, 1e-12, 100);
  rolling.predict(1e-3, {0, 0});
  rolling.correct(velocity * 1e-3 - rolling.position(), 1e-18);
  REQUIRE(rolling.velocity().norm() == Approx(1).epsilon(1e-3));
  position = rolling.position();
  velocity = rolling.velocity();
  const double dt = 1e-5;
  for (double t = 0; t < 3; t += dt) {
    const double speed = velocity.norm();
    if (speed > 0) velocity *= std::max(0.0, 1 - 0.5 * dt / speed);
    position += velocity * dt;
  }
  rolling.predict(3, {0, 0}, 0.5);
  CHECK(rolling.velocity().norm() < 1e-9);
  CHECK((rolling.position() - position).norm() < 1e-4);
}

}  // namespace sidestep::kalman_test
