// SPDX-License-Identifier: Apache-2.0
#include "tests/catch.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::tracker_identity_test {

using namespace sidestep::test;

/// Feeds noisy observations of a robot at rest from one time to another.
void feed_at_rest(TrackerFixture& fixture, const Vec2& position_m, double from_s, double to_s, Rng& rng) {
  for (Time t = after_s(from_s); t < after_s(to_s); t += kFrame) {
    msg::DetectionFrame frame = frame_message(0, t);
    add_noisy_robot(frame, 0, {position_m, {0, 0}, 0}, {}, rng);
    fixture.feed(frame);
  }
}

TEST_CASE("a robot is published after three consistent observations and not before") {
  TrackerFixture fixture(1);
  for (int i = 0; i < 3; ++i) {
    const Time t = kBegin + i * kFrame;
    CHECK(fixture.robot_at(0, t) == nullptr);
    msg::DetectionFrame frame = frame_message(0, t);
    add_robot(frame, 0, {1 + 0.03 * i, 2});
    fixture.feed(frame);
  }
  const auto* robot = fixture.robot_at(0, kBegin + 2 * kFrame);
  REQUIRE(robot);
  CHECK(robot->x_m() == Approx(1.06).margin(0.002));
  CHECK(robot->vx_mps() == Approx(1.8).margin(0.2));
}

TEST_CASE(
    "a lost robot is published with growing variance, then dropped, and published again when it reappears") {
  Rng rng(71);
  TrackerFixture fixture(1);
  feed_at_rest(fixture, {1, 1}, 0, 1, rng);
  double last = 0;
  for (double t = 1; t < 1.95; t += 0.05) {
    const auto* robot = fixture.robot_at(0, after_s(t));
    REQUIRE(robot);
    CHECK(robot->position_variance_m2() > last);
    CHECK(robot->observed_at_ns() < to_ns(after_s(1)));
    last = robot->position_variance_m2();
  }
  CHECK(fixture.robot_at(0, after_s(2.05)) == nullptr);
  feed_at_rest(fixture, {-2, 0.5}, 2.5, 2.6, rng);
  const auto* robot = fixture.robot_at(0, after_s(2.6));
  REQUIRE(robot);
  CHECK((position_of(*robot) - Vec2(-2, 0.5)).norm() < 0.01);
}

TEST_CASE("a robot that brakes to a halt unobserved stays within the published uncertainty") {
  const double gap_s = GENERATE(0.05, 0.1, 0.2, 0.4, 0.9);
  CAPTURE(gap_s);
  Rng rng(72);
  TrackerFixture fixture(1);
  const TrueMotion driving = TrueMotion::accelerating({{0, 0}, {2, 0}, 0}, {0, 0}, 0, 1);
  Time t = kBegin;
  for (; t < after_s(0.5); t += kFrame) {
    msg::DetectionFrame frame = frame_message(0, t);
    add_noisy_robot(frame, 0, driving.at(t), {}, rng);
    fixture.feed(frame);
  }
  const Time last = t - kFrame;
  const double braking_s = std::min(gap_s, 0.4);
  const Vec2 truth = driving.at(last).position_m + Vec2(2 * braking_s - 2.5 * braking_s * braking_s, 0);
  const auto* robot = fixture.robot_at(0, last + from_seconds(gap_s));
  REQUIRE(robot);
  CHECK((position_of(*robot) - truth).norm() < 3 * std::sqrt(robot->position_variance_m2()));
}

TEST_CASE("ghosts neither move an observed robot nor create a robot, and are counted") {
  const std::uint64_t seed = GENERATE(81u, 82u, 83u);
  CAPTURE(seed);
  Rng rng(seed);
  const TrueMotion motion = TrueMotion::driving(rng, 30);
  TrackerFixture fixture(2);
  std::uint64_t ghosts = 0;
  for (Time t = kBegin; t < after_s(30); t += kFrame) {
    msg::DetectionFrame frame = frame_message(0, t);
    for (RobotId id = 0; id < 2; ++id) {
      if (!rng.chance(0.3)) continue;
      const double angle_rad = rng.uniform(0, 6.28);
      const Vec2 offset = rotated({rng.uniform(0.2, 5), 0}, angle_rad);
      add_robot(frame, id, motion.at(t).position_m + offset, rng.uniform(-3, 3));
      ++ghosts;
    }
    add_noisy_robot(frame, 0, motion.at(t), {}, rng);
    fixture.feed(frame);
    const auto& world = fixture.world_at(t);
    REQUIRE(world.robots().size() <= 1);
    if (t < after_s(1)) continue;
    REQUIRE(world.robots().size() == 1);
    REQUIRE(world.robots()[0].robot() == 0);
    REQUIRE((position_of(world.robots()[0]) - motion.at(t).position_m).norm() < 0.01);
  }
  // The last ghosts of both robots are not classified yet.
  CHECK(fixture.rejected() + 4 >= ghosts);
  CHECK(fixture.rejected() <= ghosts + 4);
}

TEST_CASE("a ghost within the uncertainty of an unobserved robot does not take over its track") {
  Rng rng(93);
  TrackerFixture fixture(1);
  feed_at_rest(fixture, {1, 1}, 0, 1, rng);
  msg::DetectionFrame ghost = frame_message(0, after_s(1.6));
  add_robot(ghost, 0, {1.4, 1});
  fixture.feed(ghost);
  const auto* robot = fixture.robot_at(0, after_s(1.6));
  REQUIRE(robot);
  REQUIRE(3 * std::sqrt(robot->position_variance_m2()) > 0.4);
  CHECK((position_of(*robot) - Vec2(1, 1)).norm() < 0.1);
  CHECK(robot->observed_at_ns() < to_ns(after_s(1)));
}

TEST_CASE("a wrong heading does not turn a robot's track and is counted") {
  Rng rng(94);
  TrackerFixture fixture(1);
  feed_at_rest(fixture, {1, 1}, 0, 1, rng);
  msg::DetectionFrame wrong = frame_message(0, after_s(1));
  add_robot(wrong, 0, {1, 1}, 2);
  fixture.feed(wrong);
  feed_at_rest(fixture, {1, 1}, 1.01, 1.02, rng);
  const auto* robot = fixture.robot_at(0, after_s(1.02));
  REQUIRE(robot);
  CHECK(std::abs(robot->heading_rad()) < 0.03);
  CHECK(std::abs(robot->angular_radps()) < 2);
  CHECK(fixture.rejected() == 1);
}

TEST_CASE("a robot that was carried away is soon tracked at its new position") {
  Rng rng(91);
  TrackerFixture fixture(1);
  feed_at_rest(fixture, {1, 1}, 0, 1, rng);
  feed_at_rest(fixture, {3, 2}, 1, 1.1, rng);
  CHECK((position_of(*fixture.robot_at(0, after_s(1.1))) - Vec2(1, 1)).norm() < 0.05);
  feed_at_rest(fixture, {3, 2}, 1.1, 1.3, rng);
  CHECK((position_of(*fixture.robot_at(0, after_s(1.3))) - Vec2(3, 2)).norm() < 0.01);
}

TEST_CASE("from the second frame on, a robot that was put elsewhere is published as seen elsewhere") {
  Rng rng(95);
  TrackerFixture fixture(1);
  feed_at_rest(fixture, {1, 1}, 0, 1, rng);
  CHECK_FALSE(fixture.robot_at(0, after_s(1))->is_seen_elsewhere());
  const auto feed = [&](double at_s, const Vec2& at_m) {
    msg::DetectionFrame frame = frame_message(0, after_s(at_s));
    add_noisy_robot(frame, 0, {at_m, {0, 0}, 0}, {}, rng);
    fixture.feed(frame);
    return fixture.robot_at(0, after_s(at_s))->is_seen_elsewhere();
  };
  CHECK_FALSE(feed(1.02, {3, 2}));
  CHECK(feed(1.04, {3, 2}));
  SECTION("until its track moves there") {
    double at_s = 1.06;
    while (at_s < 1.4 && feed(at_s, {3, 2})) at_s += 0.02;
    CHECK(at_s < 1.3);
    CHECK((position_of(*fixture.robot_at(0, after_s(at_s))) - Vec2(3, 2)).norm() < 0.01);
  }
  SECTION("until it is observed at its own place again") { CHECK_FALSE(feed(1.06, {1, 1})); }
}

TEST_CASE("a robot that was rotated on the spot is tracked again") {
  Rng rng(92);
  TrackerFixture fixture(1);
  feed_at_rest(fixture, {1, 1}, 0, 1, rng);
  for (Time t = after_s(1); t < after_s(1.3); t += kFrame) {
    msg::DetectionFrame frame = frame_message(0, t);
    add_noisy_robot(frame, 0, {{1, 1}, {0, 0}, 3}, {}, rng);
    fixture.feed(frame);
  }
  CHECK(fixture.robot_at(0, after_s(1.3))->heading_rad() == Approx(3).margin(0.05));
}

TEST_CASE("robots that are not on the roster are ignored") {
  TrackerFixture fixture(2);
  for (int i = 0; i < 10; ++i) {
    msg::DetectionFrame frame = frame_message(0, kBegin + i * kFrame);
    add_robot(frame, 1, {0, 0});
    add_robot(frame, 2, {1, 0});
    add_robot(frame, 1023, {2, 0});
    fixture.feed(frame);
  }
  const auto& world = fixture.world_at(kBegin + 9 * kFrame);
  REQUIRE(world.robots().size() == 1);
  CHECK(world.robots()[0].robot() == 1);
  CHECK(fixture.rejected() == 20);
}

TEST_CASE("two robots that pass within 0.19 m never swap, even if a camera occasionally confuses them") {
  const std::uint64_t seed = GENERATE(range(100u, 130u));
  const double speed_mps = GENERATE(0.3, 2.0);
  CAPTURE(seed, speed_mps);
  Rng rng(seed);
  const double half_s = 1 / speed_mps;
  const TrueMotion right = TrueMotion::accelerating({{-1, 0.095}, {speed_mps, 0}, 0}, {0, 0}, 0, 2 * half_s);
  const TrueMotion left = TrueMotion::accelerating({{1, -0.095}, {-speed_mps, 0}, 0}, {0, 0}, 0, 2 * half_s);
  TrackerFixture fixture(2);
  int mixed_up = 0;
  for (Time t = kBegin; t < after_s(2 * half_s); t += kFrame) {
    if (mixed_up > -10) --mixed_up;
    if (mixed_up == -10 && t > after_s(0.2) && rng.chance(0.3)) mixed_up = 3;
    msg::DetectionFrame frame = frame_message(0, t);
    const CameraNoise noise;
    if (!rng.chance(0.02)) add_noisy_robot(frame, mixed_up > 0 ? 1 : 0, right.at(t), noise, rng);
    if (!rng.chance(0.02)) add_noisy_robot(frame, mixed_up > 0 ? 0 : 1, left.at(t), noise, rng);
    const Time now = t + 35 * kMs;
    fixture.feed(frame, now);
    if (t < after_s(0.15)) continue;
    for (RobotId id = 0; id < 2; ++id) {
      const auto* robot = fixture.robot_at(id, now);
      REQUIRE(robot);
      const Vec2 truth = (id == 0 ? right : left).at(t).position_m +
                         (now - t).count() * 1e-9 * (id == 0 ? right : left).at(t).velocity_mps;
      REQUIRE((position_of(*robot) - truth).norm() < 0.05);
    }
  }
}

TEST_CASE("an unobserved ball bounces off the wall and off robots") {
  // Closed-form reference from the last observation: straight motion with friction, then back at the speed
  // times the restitution.
  const bool is_robot = GENERATE(false, true);
  CAPTURE(is_robot);
  Scenario scenario;
  scenario.field = {4, 3};
  TrackerSettings settings = tracker_settings(scenario);
  const std::vector<RobotId> roster{0};
  Tracker tracker(settings, roster);
  const double turn_x_m =
      is_robot ? 1.2 - scenario.radius_m - RollingBall::kRadius_m : 2 - RollingBall::kRadius_m;
  const double restitution = is_robot ? RollingBall::kRobotRestitution : RollingBall::kWallRestitution;
  const double observed_until_s = is_robot ? 0.25 : 0.6, speed_mps = 3;
  const auto rolled_m = [&](double t_s) {
    return speed_mps * t_s - RollingBall::kFriction_mps2 * t_s * t_s / 2;
  };
  Frame frame;
  for (double t_s = 0; t_s < observed_until_s; t_s += to_seconds(kFrame)) {
    msg::DetectionFrame message = frame_message(0, after_s(t_s));
    add_ball(message, {rolled_m(t_s), 0.3});
    if (is_robot) {
      Rng rng(5);
      add_noisy_robot(message, 0, {{1.2, 0.3}, {0, 0}, 0}, {0, 0}, rng);
    }
    frame.assign(message, after_s(t_s));
    tracker.update(frame);
  }
  msg::WorldState world;
  int after_bounce = 0;
  for (double t_s = observed_until_s; t_s < observed_until_s + 0.4; t_s += 0.01) {
    tracker.world_at(after_s(t_s), world);
    REQUIRE(world.ball().is_visible());
    double expected_m = rolled_m(t_s);
    if (expected_m > turn_x_m) {
      const double discriminant = speed_mps * speed_mps - 2 * RollingBall::kFriction_mps2 * turn_x_m;
      const double since_s = t_s - (speed_mps - std::sqrt(discriminant)) / RollingBall::kFriction_mps2;
      expected_m = turn_x_m - restitution * std::sqrt(discriminant) * since_s +
                   RollingBall::kFriction_mps2 * since_s * since_s / 2;
      ++after_bounce;
    }
    CAPTURE(t_s, expected_m);
    CHECK(std::abs(world.ball().x_m() - expected_m) < 0.03);
    CHECK(std::abs(world.ball().y_m() - 0.3) < 0.01);
  }
  CHECK(after_bounce > 10);
}

TEST_CASE("a ball is found, tracked, kicked and lost, and a second ball does not interfere") {
  Rng rng(141);
  TrackerFixture fixture(0);
  Vec2 position{-2, 0}, velocity{2, 0};
  for (Time t = kBegin; t < after_s(2); t += kFrame) {
    if (t >= after_s(1) && t - kFrame < after_s(1)) velocity = {0, 6};
    msg::DetectionFrame frame = frame_message(0, t);
    if (t > after_s(0.3)) add_ball(frame, {-3, -2});
    add_ball(frame, position + 0.0015 * normal_vector(rng));
    fixture.feed(frame);
    const auto ball = fixture.world_at(t).ball();
    const bool is_settled = (t > after_s(0.2) && t < after_s(1)) || t > after_s(1.2);
    if (is_settled) {
      REQUIRE(ball.is_visible());
      CHECK((Vec2(ball.x_m(), ball.y_m()) - position).norm() < 0.01);
      CHECK((Vec2(ball.vx_mps(), ball.vy_mps()) - velocity).norm() < 0.8);
    }
    velocity -= velocity.normalized() * 0.3 * to_seconds(kFrame);
    position += velocity * to_seconds(kFrame);
  }
  CHECK(fixture.world_at(after_s(2)).ball().is_visible());
  CHECK_FALSE(fixture.world_at(after_s(2.6)).ball().is_visible());
}

}  // namespace sidestep::tracker_identity_test
