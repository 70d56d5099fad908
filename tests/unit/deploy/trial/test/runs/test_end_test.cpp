// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/test_end.hpp"

#include <set>

#include "tests/catch.hpp"

namespace sidestep::test_end_test {

FaultTest test_with(const std::string& keys) {
  return parse_fault_test(
      "time_limit_s: 20\nrobots:\n  - {id: 1, start_m: [-2, 0], goals_m: [[2, 0]]}\n"
      "  - {id: 2, start_m: [-2, 1], goals_m: [[2, 1]]}\n" +
          keys,
      "file.yaml");
}

/// The time at which the run ends if these robots have arrived from 5 s on.
double end_s(const std::string& keys, const std::set<RobotId>& arriving) {
  TestEnd end(test_with(keys));
  for (int i = 0;; ++i) {
    const double at_s = 0.05 * i;
    std::vector<RobotProgress> progress(2);
    for (const RobotId robot : {1u, 2u}) {
      progress[robot - 1].robot = robot;
      progress[robot - 1].is_done = at_s >= 5 && arriving.contains(robot);
    }
    if (end.update(at_s, progress)) return at_s;
  }
}

TEST_CASE("a run ends half a second after the expected robots have arrived") {
  CHECK(end_s("expect: [{no_contact: all}]\n", {1, 2}) == Approx(5.5).margin(0.051));
  CHECK(end_s("expect: [{arrived: 1}]\n", {1}) == Approx(5.5).margin(0.051));
  CHECK(end_s("expect: [{not_arrived: 2}]\n", {1}) == Approx(5.5).margin(0.051));
  CHECK(end_s("expect: [{arrived: all, by_s: 15}]\n", {1, 2}) == Approx(5.5).margin(0.051));
}

TEST_CASE("a run ends at the time limit if the expected robots do not arrive") {
  CHECK(end_s("expect: [{no_contact: all}]\n", {1}) == Approx(20).margin(0.051));
  CHECK(end_s("expect: [{arrived: 2}]\n", {1}) == Approx(20).margin(0.051));
}

TEST_CASE("a run does not end before all faults and spans are over") {
  CHECK(end_s("faults: [{at_s: 6, pause: vision, seconds: 3}]\nexpect: [{no_contact: all}]\n", {1, 2}) ==
        Approx(9.5).margin(0.051));
  CHECK(end_s("expect: [{at_rest: 1, within_s: 7, for_s: 4}]\n", {1, 2}) == Approx(11.5).margin(0.051));
  CHECK(end_s("expect: [{max_speed_mps: 1, to_s: 12}]\n", {1, 2}) == Approx(12.5).margin(0.051));
}

}  // namespace sidestep::test_end_test
