// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/stranger_watch.hpp"

#include <vector>

#include "common/messaging/blockage_text.hpp"
#include "tests/catch.hpp"

namespace sidestep::stranger_watch_test {

using std::chrono::milliseconds;

const Time kBegin = time_from_ns(1'000'000'000);
constexpr Duration kCycle = milliseconds(20);

struct Fixture {
  FloorRules rules;
  StrangerWatch watch{rules};
  std::vector<MovingObstacle> strangers;
  Vec2 velocity_mps{0, 0};
  Time now = kBegin;

  void run(Duration duration, bool is_free) {
    for (const Time end = now + duration; now < end; now += kCycle) {
      watch.close_cycle(now);
      for (MovingObstacle& stranger : strangers) stranger.observed_at = now - milliseconds(40);
      SearchQuery query{now + kCycle, {{0, 0}, velocity_mps}, {3, 0}, kCycle};
      query.moving = strangers;
      watch.update(query, is_free, now);
    }
  }
};

TEST_CASE("the nearest stranger that stops a robot is named within a quarter of a second, then forgotten") {
  Fixture f;
  f.strangers = {{{0.4, 0}, 0.09, {}, 1.5}, {{0, 0.25}, 0.09, {}, 1.5}};
  f.run(milliseconds(100), false);
  CHECK_FALSE(f.watch.lasting());
  f.run(milliseconds(160), false);
  REQUIRE(f.watch.lasting());
  CHECK(to_text(*f.watch.lasting()) == "a stranger 0.25 m away, who may move at 1.5 m/s");
  f.run(milliseconds(100), true);
  CHECK(f.watch.lasting());
  f.run(milliseconds(1000), true);
  CHECK_FALSE(f.watch.lasting());
  f.run(milliseconds(100), false);
  CHECK_FALSE(f.watch.lasting());
}

TEST_CASE("no stranger is named if the robot drives, or if something else is in its way") {
  Fixture f;
  f.strangers = {{{0.25, 0}, 0.09, {}, 1.5}};
  f.velocity_mps = {0.5, 0};
  f.run(milliseconds(500), false);
  CHECK_FALSE(f.watch.lasting());
  f.velocity_mps = {0, 0};
  f.strangers = {{{2, 0}, 0.09, {}, 1.5}};
  f.run(milliseconds(500), false);
  CHECK_FALSE(f.watch.lasting());
}

TEST_CASE("a stranger is forgotten when the robot's clock is set back") {
  Fixture f;
  f.strangers = {{{0.25, 0}, 0.09, {}, 1.5}};
  f.run(milliseconds(500), false);
  REQUIRE(f.watch.lasting());
  f.now -= std::chrono::hours(1);
  f.run(milliseconds(20), true);
  CHECK_FALSE(f.watch.lasting());
}

}  // namespace sidestep::stranger_watch_test
