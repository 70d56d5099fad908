// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/completeness_monitor.hpp"

#include "common/protocol/obstacle_bounds.hpp"
#include "tests/catch.hpp"

namespace sidestep::completeness_monitor_test {

constexpr Duration kSlack{1'000'000};
constexpr Duration kNoLag{0};

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

WorldObservations world(double valid_at, const Vec2& self_m, Incarnation vision = 1) {
  WorldObservations result{vision, at_s(valid_at)};
  result.self = PoseFix{at_s(valid_at - 0.02), {9, 9}, 0};
  result.self_m = self_m;
  return result;
}

ObstacleObservations list(double valid_at, double complete_within_m, Incarnation vision = 1) {
  return {vision, at_s(valid_at), complete_within_m, {}};
}

struct Fixture {
  CompletenessMonitor monitor{1.5, kSlack};
  SeenRegion seen(Duration max_lag = kNoLag) const { return monitor.seen(at_s(10), max_lag); }
};

TEST_CASE("nothing counts as seen before the first list") {
  Fixture f;
  f.monitor.on_world_state(world(10, {1, 2}));
  CHECK(f.monitor.complete_at() == Time{});
  CHECK(f.seen().radius_m == 0);
}

TEST_CASE(
    "a complete list is usable alone, but an incomplete list only with the world state of the same time") {
  Fixture f;
  f.monitor.on_list(list(10, kCompleteEverywhere_m));
  CHECK(f.monitor.complete_at() == at_s(10));
  CHECK(f.seen().is_everywhere());
  f.monitor.on_list(list(10.1, 2));
  CHECK(f.monitor.complete_at() == at_s(10));
  f.monitor.on_world_state(world(10.1, {1, 2}));
  CHECK(f.monitor.complete_at() == at_s(10.1));
  CHECK(f.seen().centre_m == Vec2(1, 2));
  CHECK(f.seen().radius_m == 2);
  CHECK(f.seen().observed_at == at_s(10.1) - kSlack);
  CHECK(f.seen().speed_mps == 1.5);
  // If the robot may lag, its seen region is smaller.
  CHECK(f.seen(from_seconds(0.06)).radius_at_m(at_s(11)) ==
        Approx(f.seen().radius_at_m(at_s(11)) - 1.5 * 0.06));
  // The next world state arrives before its list.
  f.monitor.on_world_state(world(10.2, {1, 3}));
  f.monitor.on_list(list(10.2, 1));
  CHECK(f.monitor.complete_at() == at_s(10.2));
  CHECK(f.seen().centre_m == Vec2(1, 3));
  CHECK(f.seen().radius_m == 1);
}

TEST_CASE(
    "an incomplete list is usable only with a world state of the same process and time that contains the "
    "robot") {
  Fixture f;
  f.monitor.on_list(list(10, 2));
  WorldObservations without_self = world(10, {1, 2});
  without_self.self.reset();
  f.monitor.on_world_state(without_self);
  f.monitor.on_world_state(world(10, {1, 2}, 2));
  f.monitor.on_world_state(world(10.001, {1, 2}));
  CHECK(f.monitor.complete_at() == Time{});
  f.monitor.on_world_state(world(10, {1, 2}));
  CHECK(f.monitor.complete_at() == at_s(10));
}

TEST_CASE("late and repeated lists and world states do not replace newer ones") {
  Fixture f;
  f.monitor.on_world_state(world(10, {1, 2}));
  f.monitor.on_world_state(world(9.9, {0, 0}));
  f.monitor.on_list(list(10, 2));
  f.monitor.on_list(list(9.9, 1));
  f.monitor.on_list(list(10, 3));
  f.monitor.on_list(list(9.95, kCompleteEverywhere_m));
  CHECK(f.monitor.complete_at() == at_s(10));
  CHECK(f.seen().radius_m == 2);
  // A list that is still waiting for its world state is superseded.
  f.monitor.on_list(list(10.1, 1));
  f.monitor.on_list(list(10.2, kCompleteEverywhere_m));
  f.monitor.on_world_state(world(10.1, {1, 2}));
  CHECK(f.monitor.complete_at() == at_s(10.2));
  CHECK(f.seen().is_everywhere());
}

TEST_CASE("the latest world states are remembered for lists that arrive later") {
  Fixture f;
  for (int k = 0; k < 100; ++k) f.monitor.on_world_state(world(10 + 0.01 * k, {0.1 * k, 0}));
  f.monitor.on_list(list(10.9, 1));
  CHECK(f.seen().centre_m.x() == Approx(9));
  f.monitor.on_list(list(10.3, 1));
  CHECK(f.monitor.complete_at() == at_s(10.9));
}

TEST_CASE("forgotten obstacles limit the seen region until the time at which they would have been dropped") {
  Fixture f;
  f.monitor.on_list(list(10, kCompleteEverywhere_m));
  f.monitor.on_forgotten({{0, 0}, 3, at_s(10), 1.5}, at_s(11));
  CHECK(f.monitor.seen(at_s(10.5), kNoLag).radius_m == 3);
  f.monitor.on_forgotten({{1, 0}, 2.5, at_s(10.2), 1.5}, at_s(11.2));
  // The first region contains a disc with a radius of 3 m - 0.2 s * 1.5 m/s - 1 m around the new centre.
  CHECK(f.monitor.seen(at_s(10.5), kNoLag).centre_m == Vec2(1, 0));
  CHECK(f.monitor.seen(at_s(10.5), kNoLag).radius_m == Approx(1.7));
  f.monitor.on_world_state(world(10.4, {1, 0.5}));
  f.monitor.on_list(list(10.4, 1));
  CHECK(f.monitor.seen(at_s(10.5), kNoLag).centre_m == Vec2(1, 0.5));
  CHECK(f.monitor.seen(at_s(10.5), kNoLag).radius_m == Approx(1.7 - 0.5 - 0.199 * 1.5));
  CHECK(f.monitor.seen(at_s(11.1), kNoLag).radius_m < 1);
  CHECK(f.monitor.seen(at_s(11.3), kNoLag).radius_m == 1);
}

}  // namespace sidestep::completeness_monitor_test
