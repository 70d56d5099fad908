// SPDX-License-Identifier: Apache-2.0
#include "tests/study/vision/vision_study.hpp"

#include "tests/catch.hpp"
#include "tests/study/vision/frame_times.hpp"
#include "tests/study/vision/marker_errors.hpp"
#include "tests/study/vision/recognition.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::vision_study_test {

TEST_CASE("the results of all experiments depend only on the seed") {
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return recognition({.frames = 3}, seed, advance);
  });
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return marker_errors({.frames = 3, .noises = {2}}, seed, advance);
  });
  check_experiment([](std::uint64_t seed, const ProgressCallback& advance) {
    return frame_times({.rounds = 3}, seed, advance);
  });
}

TEST_CASE("robots in frames are identified and located correctly") {
  const auto rows = rows_of(recognition({.frames = 100}, 3, [](auto, auto) {}));
  REQUIRE(rows.size() == 8);
  for (const StudyRow& row : rows) {
    CAPTURE(row.at("colours"), row.at("light"), row.at("robots"));
    // In dark and tinted light the default thresholds fit badly.
    const bool is_hard = row.at("colours") == "default" && row.at("light") == "both";
    CHECK(std::stod(row.at("found_percent")) >= (is_hard                                ? 85
                                                 : row.at("light") == "one dot covered" ? 99
                                                                                        : 99.5));
    CHECK(row.at("misidentified") == "0");
    CHECK(std::stod(row.at("rms_mm")) < 1.5);
    CHECK(std::stod(row.at("rms_mm")) > 0.1);
    CHECK(std::stod(row.at("max_mm")) >= std::stod(row.at("rms_mm")));
  }
}

TEST_CASE("pose errors agree with the prediction from the errors of the dots") {
  const auto rows = rows_of(marker_errors({.frames = 200, .noises = {2, 6}}, 3, [](auto, auto) {}));
  for (const StudyRow& row : rows) {
    CAPTURE(row.at("noise"));
    CHECK(std::stod(row.at("centroid_mm")) == Approx(std::stod(row.at("predicted_mm"))).epsilon(0.05));
    CHECK(std::stod(row.at("degrees")) == Approx(std::stod(row.at("predicted_degrees"))).epsilon(0.075));
  }
}

TEST_CASE("the quick study of vision writes all its tables and pictures") {
  StudyFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.seed = 7;
  options.is_quick = true;
  REQUIRE(study_vision(options) == 0);
  for (const char* name : {"recognition", "marker-errors", "frame-times"}) {
    CAPTURE(name);
    CHECK(folder.table("vision", name, 7).size() >= 2);
    CHECK(folder.has_png(name));
  }
}

}  // namespace sidestep::vision_study_test
