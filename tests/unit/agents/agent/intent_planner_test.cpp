// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/intent_planner.hpp"

#include "agents/agent/planning_distances.hpp"
#include "agents/navigation/trapezoidal_profile.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::intent_planner_test {

using namespace std::chrono_literals;

constexpr Time kStart = time_from_ns(1'800'000'000'000'000'000);

/// A robot at rest on an empty floor that chooses its intents, without driving.
struct Chooser {
  Intent choose(const Vec2& target_m, Time start) {
    const auto route = routes.find({target_m, at_start.position_m, at_start.position_m, start}, {}, rng);
    REQUIRE(route);
    return intents.choose({at_start, start, *route, 100ms}, routes, neighbours);
  }
  Time expected_due(const Vec2& target_m, Time start) const {
    const double length_m = (target_m - at_start.position_m).norm();
    return start + from_seconds(TrapezoidalProfile::duration_s(length_m, 0, rules.limits));
  }

  FloorRules rules;
  Rng rng{1};
  RouteToTarget routes{make_driving_planner("lazy-visibility"), rules, {&kExtraClearance_m, 1}};
  Steering steering{rules.field, rules.radius_m, rules.limits};
  IntentPlanner intents{7, std::nullopt, rules, steering};
  Neighbours neighbours{7};
  State at_start{{-2, 1}, {0, 0}};
};

TEST_CASE("a robot is due at its goal when it would arrive alone on a free floor") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Chooser chooser;
    chooser.at_start.position_m = random_vector(rng, 2.5);
    const Vec2 target_m = random_vector(rng, 2.5);
    const Intent intent = chooser.choose(target_m, kStart);
    CHECK(std::abs(to_seconds(intent.due - chooser.expected_due(target_m, kStart))) < 1e-6);
    CHECK((intent.goal_m - target_m).norm() < 1e-9);
  }
}

TEST_CASE("a robot chooses when it is due once for each goal, however it moves on") {
  Chooser chooser;
  const Time due = chooser.choose({2, 1}, kStart).due;
  chooser.at_start = {{-1, 1}, {1.5, 0}};
  CHECK(chooser.choose({2, 1}, kStart + 500ms).due == due);
  chooser.at_start = {{-2.5, -1}, {0, 0}};  // pushed back
  CHECK(chooser.choose({2, 1}, kStart + 1s).due == due);
  CHECK(chooser.choose({2, 1}, due + 5s).due == due);
}

TEST_CASE("a robot with another goal is due at another time") {
  Chooser chooser;
  const Time due = chooser.choose({2, 1}, kStart).due;
  CHECK(chooser.choose({2, -2}, kStart + 500ms).due == due);  // the route leads elsewhere for a while
  chooser.intents.on_new_goal();
  const Time start = kStart + 1s;
  const Time anew = chooser.choose({2, -2}, start).due;
  CHECK(std::abs(to_seconds(anew - chooser.expected_due({2, -2}, start))) < 1e-6);
  CHECK(chooser.choose({2, -2}, start + 1s).due == anew);
}

TEST_CASE("a robot that is overdue by more than ten seconds is due as if it had just set out") {
  Chooser chooser;
  const Vec2 target_m(2, 1);
  Time due = chooser.choose(target_m, kStart).due;
  for (int round = 0; round < 3; ++round) {
    CAPTURE(round);
    CHECK(chooser.choose(target_m, due + 10s).due == due);
    const Time start = due + 10s + 1ms;
    due = chooser.choose(target_m, start).due;
    CHECK(std::abs(to_seconds(due - chooser.expected_due(target_m, start))) < 1e-6);
  }
}

TEST_CASE("a robot whose clock was set back is due soon again") {
  Chooser chooser;
  chooser.choose({2, 1}, kStart);
  chooser.intents.on_new_goal();
  const Time start = kStart - 100s;
  const Time due = chooser.choose({2, 1}, start).due;
  CHECK(std::abs(to_seconds(due - chooser.expected_due({2, 1}, start))) < 1e-6);
}

}  // namespace sidestep::intent_planner_test
