// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/learn_colours.hpp"

#include "tests/catch.hpp"
#include "tests/unit/vision/calibrate/rendered_start.hpp"

namespace sidestep::learn_colours_test {

using namespace sidestep::test;

TEST_CASE("colours learned from one frame find robots and obstacles in different light") {
  const auto format = GENERATE(PixelFormat::kYuv422, PixelFormat::kRgb);
  const double drift = GENERATE(0.0, 0.1, -0.1);
  CAPTURE(format, drift);
  const Scenario scenario = load_scenario(kFloorFile);
  const CameraModel camera = camera_grid(scenario)[0];
  RenderSpec spec;
  spec.format = format;
  const Image image = rendered_start(scenario, camera, spec, 1);
  const std::vector<LabelledImage> labelled{
      {image.view(), floor_labels_at_start(scenario, butterfly(), camera)}};
  const LearnedColours learned = learn_colours(labelled, colours_at_start(scenario, butterfly()));
  CHECK(learned.warnings.empty());
  CHECK(learned.thresholds.format == format);
  REQUIRE(learned.colours.size() == 5);
  for (const LearnedColour& one : learned.colours) {
    CHECK(one.pixels > 30);
    CHECK(one.recall > 0.99);
  }
  CHECK(learned.ground_false_positives < 1e-3);

  spec.colour_gain = {1 + drift, 1, 1 - drift};
  spec.far_light = 0.7;
  Detector detector(camera, settings_of(scenario, learned.thresholds.boxes));
  msg::DetectionFrame frame;
  for (std::uint64_t seed = 2; seed < 7; ++seed) {
    CAPTURE(seed);
    detector.detect(rendered_start(scenario, camera, spec, seed).view(), {}, {}, frame);
    CHECK(found_at_start(scenario, frame) == scenario.robots.size());
    if (drift == 0) CHECK(frame.ball_count() == 1);
    // The obstacle's and the opponent's colours were not learned.
    CHECK(frame.obstacle_count() == 2);
  }
}

TEST_CASE("learning warns of missing colours and misplaced labels") {
  const Scenario scenario = load_scenario(kFloorFile);
  const CameraModel camera = camera_grid(scenario)[0];
  RenderSpec spec;
  const Image image = rendered_start(scenario, camera, spec, 1);
  FloorLabels labels = floor_labels_at_start(scenario, butterfly(), camera);
  const std::vector<Colour> expected = colours_at_start(scenario, butterfly());
  const auto warnings = [&] {
    const std::vector<LabelledImage> labelled{{image.view(), labels}};
    std::string all;
    for (const std::string& warning : learn_colours(labelled, expected).warnings) all += warning + "\n";
    return all;
  };
  SECTION("a colour is missing") {
    std::erase_if(labels.discs, [](const LabelledDisc& disc) { return disc.colour == Colour::kYellow; });
    CHECK_THAT(warnings(), ContainsSubstring("the images show nothing yellow"));
  }
  SECTION("labels are swapped") {
    for (LabelledDisc& disc : labels.discs) {
      const bool is_pink = disc.colour == Colour::kPink, is_green = disc.colour == Colour::kGreen;
      if ((is_pink || is_green) && disc.centre_px.x() < 390)
        disc.colour = is_pink ? Colour::kGreen : Colour::kPink;
    }
    CHECK_THAT(warnings(), ContainsSubstring("green and pink overlap"));
    CHECK_THAT(warnings(), ContainsSubstring("of the pixels labelled pink"));
  }
  SECTION("all labels are displaced by 20 pixels") {
    for (LabelledDisc& disc : labels.discs) disc.centre_px.x() += 20;
    CHECK_THAT(warnings(), ContainsSubstring("check that everything is at its start position"));
  }
}

TEST_CASE("the labels of a floor are the discs in its camera's view") {
  const Scenario scenario = load_scenario(kFloorFile);
  const CameraModel camera = camera_grid(scenario)[0];
  const FloorLabels labels = floor_labels_at_start(scenario, butterfly(), camera);
  CHECK(labels.discs.size() == 6 * 5 + 1);
  CHECK(labels.ignored.size() == 2 * 2);
  MarkerLayout few = butterfly();
  few.patterns.resize(12);
  CHECK_THROWS_WITH(floor_labels_at_start(scenario, few, camera),
                    ContainsSubstring("robot 12 has number 12"));
}

}  // namespace sidestep::learn_colours_test
