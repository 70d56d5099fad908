// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/drop_counters.hpp"

#include "tests/catch.hpp"

namespace sidestep::drop_counters_test {

TEST_CASE("drops are counted by reason and robot") {
  DropCounters drops;
  const std::size_t rows = drops.counts().size();
  drops.count(DropReason::kLateFact, RobotId{3});
  drops.count(DropReason::kLateFact, RobotId{3}, 4);
  drops.count(DropReason::kLateFact, RobotId{4});
  drops.count(DropReason::kLateFact);
  drops.count(DropReason::kLatePage, RobotId{3});
  CHECK(drops.counts().size() == rows + 3);
  CHECK(drops.total(DropReason::kLateFact) == 7);
  CHECK(drops.total(DropReason::kLatePage) == 1);
  CHECK(drops.total() == 8);
}

TEST_CASE("a drop reason that never occurred has no entry") {
  DropCounters drops;
  const std::size_t rows = drops.counts().size();
  drops.count(DropReason::kLateFact, RobotId{3}, 0);
  CHECK(drops.counts().size() == rows);
  DropCounters others;
  others.count(DropReason::kLateFact, RobotId{3}, 2);
  drops.add(others);
  drops.add(others);
  CHECK(drops.counts().size() == rows + 1);
  CHECK(drops.total() == 4);
}

TEST_CASE("drops are counted without the robot if the counters are full") {
  DropCounters drops;
  for (RobotId robot = 0; robot < 1000; ++robot) drops.count(DropReason::kLateFact, robot, 2);
  CHECK(drops.counts().size() == DropCounters::kCapacity);
  CHECK(drops.total(DropReason::kLateFact) == 2000);
}

}  // namespace sidestep::drop_counters_test
