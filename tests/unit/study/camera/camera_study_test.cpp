// SPDX-License-Identifier: Apache-2.0
#include "tests/study/camera/camera_study.hpp"

#include "tests/catch.hpp"
#include "tests/study/camera/guided_drive.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::camera_study_test {

TEST_CASE("the quick study guides the robot by camera without contacts or false alarms") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 2;
  options.is_quick = true;
  REQUIRE(study_camera(options) == 0);
  for (const StudyRow& row : folder.table("camera", "drives", 2)) {
    CAPTURE(row.at("event"), row.at("planner"));
    CHECK(row.at("arrived") == row.at("drives"));
    CHECK(row.at("contacts") == "0");
    CHECK(row.at("without_cause") == "0");
    CHECK(row.at("false_alarms") == "0");
  }
  const auto heuristics = folder.table("camera", "heuristics", 2);
  REQUIRE(heuristics.size() == 4);
  for (std::size_t i = 0; i < 3; ++i) CHECK(heuristics[i].at("longer") == "0");
  CHECK(folder.has_png("camera"));
}

TEST_CASE("only a robot that is pushed or whose target moves gets a new plan") {
  const std::uint64_t seed = GENERATE(5u, 6u);
  CAPTURE(seed);
  CHECK(drive(DriveEvent::kNone, PixelPlanner::kCells, seed).replans == 0);
  // The target needs two new plans, and more if the moving robot cannot turn towards its new place.
  const int replans = drive(DriveEvent::kTargetMoves, PixelPlanner::kCells, seed).replans;
  CHECK(replans >= 2);
  CHECK(replans <= 6);
  CHECK(drive(DriveEvent::kRobotPushed, PixelPlanner::kDiamonds, seed).replans >= 1);
}

TEST_CASE("a robot stops at the first image of a bumped camera and drives on once the camera is back") {
  const DriveResult result = drive(DriveEvent::kCameraBumped, PixelPlanner::kDiamonds, 7);
  CHECK(result.noticed_after_frames == 1);
  CHECK(result.blind_m < 0.2);
  CHECK(result.arrived);
  CHECK(result.contacts == 0);
}

}  // namespace sidestep::camera_study_test
