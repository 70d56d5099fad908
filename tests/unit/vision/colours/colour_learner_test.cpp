// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/colour_learner.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::colour_learner_test {

struct Sample {
  Colour colour;
  Yuv yuv;
};

/// Discs with a radius of 10 px on a floor, with uniform noise of up to `noise` in every channel.
struct Painting {
  Image image{PixelFormat::kYuv422, 400, 60};
  std::vector<LabelledDisc> discs;

  Painting(const Yuv& floor, const std::vector<Sample>& samples, int noise, Rng& rng) {
    for (std::size_t i = 0; i < samples.size(); ++i)
      discs.push_back({samples[i].colour, {30.0 + 50 * static_cast<double>(i), 30}, 10});
    const auto noisy = [&](std::uint8_t value) {
      return static_cast<std::uint8_t>(
          value + static_cast<int>(rng.below(2 * static_cast<std::size_t>(noise) + 1)) - noise);
    };
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 400; x += 2) {
        Yuv yuv = floor;
        for (std::size_t i = 0; i < samples.size(); ++i) {
          if (std::hypot(x - discs[i].centre_px.x(), y - 30.0) <= 10) yuv = samples[i].yuv;
        }
        std::uint8_t* pair = image.row(y) + 2 * x;
        pair[0] = noisy(yuv.u);
        pair[1] = noisy(yuv.y);
        pair[2] = noisy(yuv.v);
        pair[3] = noisy(yuv.y);
      }
    }
  }
};

const ColourBox* box_of(const std::vector<ColourBox>& boxes, Colour colour) {
  const auto box = std::ranges::find(boxes, static_cast<std::uint32_t>(colour), &ColourBox::colour);
  return box == boxes.end() ? nullptr : &*box;
}

bool overlap(const ColourBox& a, const ColourBox& b) {
  const auto apart = [](std::uint8_t al, std::uint8_t ah, std::uint8_t bl, std::uint8_t bh) {
    return ah < bl || bh < al;
  };
  return !apart(a.low.y, a.high.y, b.low.y, b.high.y) && !apart(a.low.u, a.high.u, b.low.u, b.high.u) &&
         !apart(a.low.v, a.high.v, b.low.v, b.high.v);
}

TEST_CASE("boxes contain the observed pixels of their colours and do not overlap") {
  const std::uint64_t seed = GENERATE(range(1, 41));
  CAPTURE(seed);
  Rng rng(seed);
  const int noise = static_cast<int>(rng.below(6));
  const auto byte = [&](int low, int high) {
    return static_cast<std::uint8_t>(low + static_cast<int>(rng.below(static_cast<std::size_t>(high - low))));
  };
  const std::vector<Sample> samples{{Colour::kOrange, {byte(120, 200), byte(40, 80), byte(185, 215)}},
                                    {Colour::kYellow, {byte(140, 220), byte(30, 70), byte(140, 165)}},
                                    {Colour::kBlue, {byte(60, 120), byte(170, 220), byte(60, 100)}},
                                    {Colour::kPink, {byte(90, 160), byte(130, 160), byte(185, 225)}}};
  const Painting painting({byte(40, 90), byte(110, 125), byte(100, 120)}, samples, noise, rng);
  ColourLearner learner;
  learner.add(painting.image.view(), painting.discs);
  const std::vector<ColourBox> boxes = learner.named_boxes();
  REQUIRE(boxes.size() == samples.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j) CHECK_FALSE(overlap(boxes[i], boxes[j]));
  }
  for (const Sample& sample : samples) {
    REQUIRE(box_of(boxes, sample.colour));
    CHECK(is_within(*box_of(boxes, sample.colour), sample.yuv));
  }
}

TEST_CASE("the border between two colours is midway between their observed ranges") {
  Rng rng(1);
  const std::vector<Sample> samples{{Colour::kOrange, {150, 60, 200}}, {Colour::kYellow, {150, 60, 160}}};
  const Painting painting({60, 120, 110}, samples, 0, rng);
  ColourLearner learner;
  learner.add(painting.image.view(), painting.discs);
  const auto boxes = learner.named_boxes();
  CHECK(box_of(boxes, Colour::kOrange)->low.v == 181);
  CHECK(box_of(boxes, Colour::kYellow)->high.v == 180);
}

TEST_CASE("pixels far from the background are classified as another colour, and background pixels are not") {
  const std::uint64_t seed = GENERATE(range(1, 41));
  CAPTURE(seed);
  Rng rng(seed);
  const auto byte = [&](int low, int high) {
    return static_cast<std::uint8_t>(low + static_cast<int>(rng.below(static_cast<std::size_t>(high - low))));
  };
  const Yuv floor{byte(40, 90), byte(105, 150), byte(105, 150)};
  const std::vector<Sample> samples{{Colour::kPink, {byte(90, 160), byte(130, 160), byte(185, 225)}}};
  const Painting painting(floor, samples, 3, rng);
  ColourLearner learner;
  learner.add(painting.image.view(), painting.discs);
  const std::vector<ColourBox> boxes = learner.other_boxes();
  const auto is_other = [&](const Yuv& pixel) {
    return std::ranges::any_of(boxes, [&](const ColourBox& box) { return is_within(box, pixel); });
  };
  for (const ColourBox& box : boxes) CHECK(box.colour == kOtherColour);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 400; ++x) {
      if (std::hypot(x - 30.0, y - 30.0) > 20) REQUIRE_FALSE(is_other(pixel_at(painting.image.view(), x, y)));
    }
  }
  for (int y = 0; y < 256; ++y) {
    const auto bright = static_cast<std::uint8_t>(y);
    CAPTURE(y);
    CHECK_FALSE(is_other({bright, 128, 128}));
    for (const int far : {-54, 54}) {
      CHECK(is_other({bright, static_cast<std::uint8_t>(floor.u + far), floor.v}));
      CHECK(is_other({bright, floor.u, static_cast<std::uint8_t>(floor.v + far)}));
    }
  }
  // White in light with a tenth more red or blue is not another colour.
  CHECK_FALSE(is_other({233, 111, 140}));
  CHECK_FALSE(is_other({225, 142, 114}));
}

TEST_CASE("named colours take precedence over unnamed ones") {
  Rng rng(1);
  const Painting painting({60, 120, 110}, {{Colour::kOrange, {150, 60, 200}}}, 0, rng);
  ColourLearner learner;
  learner.add(painting.image.view(), painting.discs);
  const ColourClasses classes(learner.boxes());
  CHECK(classes.colour_of({150, 60, 200}) == static_cast<std::uint32_t>(Colour::kOrange));
  CHECK(classes.colour_of({150, 200, 60}) == kOtherColour);
  CHECK_FALSE(classes.colour_of({60, 120, 110}));
}

TEST_CASE("nothing is learned from ignored discs") {
  Rng rng(1);
  const Painting painting({60, 120, 110}, {{Colour::kOrange, {150, 60, 200}}}, 0, rng);
  ColourLearner learner;
  learner.add(painting.image.view(), {}, painting.discs);

  CHECK(learner.named_boxes().empty());
  CHECK(ColourClasses(learner.boxes()).colour_of({150, 60, 200}) == kOtherColour);
}

TEST_CASE("a colour that was never observed has no box") {
  ColourLearner learner;
  CHECK(learner.boxes().empty());
}

}  // namespace sidestep::colour_learner_test
