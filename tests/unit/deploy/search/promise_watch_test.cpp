// SPDX-License-Identifier: Apache-2.0
#include "deploy/search/promise_watch.hpp"

#include <catch2/catch.hpp>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/codec.hpp"
#include "common/messaging/sim_bus.hpp"
#include "common/motion/clearance.hpp"
#include "deploy/search/sampled_distance.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;
using namespace std::chrono_literals;

namespace {

const Time kBegin = time_from_ns(1'000'000'000'000);

Version stand(RobotId robot, VersionNumber number, double x_m) {
  return {robot, 1, number, 0, Trajectory::resting(kBegin, {x_m, 0})};
}

/// Two robots 0.19 m apart are just clear.
struct Rig {
  Scenario scenario = parse_scenario("circle: {count: 2, spacing_m: 1}\n", "two.yaml");
  SimNetwork network{1, kBegin, {}};
  SimBus writer_bus{network}, watch_bus{network};
  PromiseWatch watch{watch_bus, scenario};
  Writer<msg::Feedback> feedback[2] = {writer_bus.advertise(topics::kFeedback, 0),
                                       writer_bus.advertise(topics::kFeedback, 1)};
  Writer<msg::LedgerPage> ledger = writer_bus.advertise(topics::kLedger);

  Rig() { watch.check_every(1); }
  void executes(const Version& version, Epoch epoch) {
    msg::Feedback fact;
    fact.robot(version.robot);
    fact.obeyed_epoch(epoch);
    fact.executing(encode(version));
    feedback[version.robot].publish(fact, network.now());
    network.run_until(network.now() + 10ms);
  }
  void holds(const std::vector<Version>& versions, Epoch epoch) {
    msg::LedgerPage page;
    page.page_count(1);
    page.epoch(epoch);
    for (const Version& version : versions) page.versions().push_back(encode(version));
    ledger.publish(page, network.now());
    network.run_until(network.now() + 10ms);
  }
};

}  // namespace

TEST_CASE("what keeps the promise is not complained of") {
  Rig rig;
  rig.executes(stand(0, 1, 0), 7);
  rig.executes(stand(1, 1, 0.1901), 7);
  rig.holds({stand(0, 1, 0), stand(0, 2, -0.1), stand(1, 1, 0.1901)}, 7);
  CHECK(rig.watch.pages() == 1);
  CHECK(rig.watch.violations() == 0);
  CHECK(rig.watch.first().empty());
}

TEST_CASE("two robots that execute what is not clear are found") {
  Rig rig;
  rig.executes(stand(0, 1, 0), 7);
  rig.executes(stand(1, 5, 0.1899), 7);
  CHECK(rig.watch.violations() == 1);
  CHECK_THAT(rig.watch.first(), Catch::Contains("robot 1 version 5"));
}

TEST_CASE("a ledger whose versions are not clear of each other is found, but not for one robot's own") {
  Rig rig;
  rig.holds({stand(0, 1, 0), stand(0, 2, 0.01), stand(1, 1, 0.5)}, 7);
  CHECK(rig.watch.violations() == 0);
  rig.holds({stand(0, 1, 0), stand(0, 2, 0.4), stand(1, 1, 0.5)}, 7);
  CHECK(rig.watch.violations() == 1);
}

TEST_CASE("a robot that was off its reference may be too near until it is clear once more") {
  Rig rig;
  rig.executes(stand(0, 1, 0), 7);
  Version measured = stand(1, 5, 0.25);
  measured.grown_m = 0.07;
  rig.executes(measured, 7);
  rig.holds({stand(0, 1, 0), measured}, 7);
  CHECK(rig.watch.violations() == 0);
  // It has its size again, is still too near, and goes away.
  rig.executes(stand(1, 6, 0.18), 7);
  rig.holds({stand(0, 1, 0), stand(1, 6, 0.18)}, 7);
  CHECK(rig.watch.violations() == 0);
  rig.executes(stand(1, 7, 0.2), 7);
  rig.holds({stand(0, 1, 0), stand(1, 7, 0.2)}, 7);
  CHECK(rig.watch.violations() == 0);
  rig.holds({stand(0, 1, 0), stand(1, 7, 0.2), stand(1, 8, 0.18)}, 7);
  CHECK(rig.watch.violations() == 1);
  rig.executes(stand(1, 8, 0.18), 7);
  CHECK(rig.watch.violations() == 2);
}

TEST_CASE("a robot that is lifted is nowhere") {
  Rig rig;
  rig.executes(stand(0, 1, 0), 7);
  rig.executes(stand(1, 1, 0.5), 7);
  msg::Feedback lifted;
  lifted.robot(1);
  lifted.is_lifted(true);
  lifted.obeyed_epoch(7);
  rig.feedback[1].publish(lifted, rig.network.now());
  rig.network.run_until(rig.network.now() + 10ms);
  rig.executes(stand(0, 2, 0.5), 7);
  rig.holds({stand(0, 2, 0.5)}, 7);
  CHECK(rig.watch.violations() == 0);
}

TEST_CASE("a robot that executes what is not in the ledger of the coordinator that it obeys is found") {
  Rig rig;
  rig.executes(stand(0, 3, 0), 7);
  rig.holds({stand(0, 2, 0), stand(1, 1, 1)}, 6);
  CHECK(rig.watch.violations() == 0);
  rig.holds({stand(0, 2, 0), stand(0, 3, 0), stand(1, 1, 1)}, 7);
  CHECK(rig.watch.violations() == 0);
  rig.holds({stand(0, 2, 0), stand(1, 1, 1)}, 7);
  CHECK(rig.watch.violations() == 1);
  CHECK_THAT(rig.watch.first(), Catch::Contains("lacks"));
}

TEST_CASE("stepping along motions finds what the clearance finds") {
  Rng rng(11);
  int near = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Trajectory a = random_trajectory(rng), b = random_trajectory(rng);
    const Time from = std::max(a.start(), b.start());
    const double exact_m = clearance_m(a, b, 0.19);
    // Within a millimetre of the limit steps of some milliseconds may miss it.
    if (std::abs(exact_m) < 0.001) continue;
    CAPTURE(i, exact_m);
    REQUIRE(come_nearer(a, b, 0.19, from) == (exact_m < 0));
    near += exact_m < 0;
  }
  CHECK(near > 100);
}
