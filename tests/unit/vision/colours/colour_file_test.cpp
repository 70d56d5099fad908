// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/colour_file.hpp"

#include "common/config/scenario_loader.hpp"
#include "common/marking/colours.hpp"
#include "tests/catch.hpp"
#include "vision/colours/colour_learner.hpp"

namespace sidestep::colour_file_test {

const std::string kGood =
    "format: rgb\n"
    "boxes:\n"
    "  - {colour: orange, low: [98, 0, 166], high: [255, 94, 255]}\n"
    "  - {colour: pink, low: [0, 1, 2], high: [3, 4, 5]}\n";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

TEST_CASE("thresholds are read from a file as they were written") {
  const ColourThresholds read = parse_colours(kGood, "f");
  CHECK(read.format == PixelFormat::kRgb);
  REQUIRE(read.boxes.size() == 2);
  CHECK(read.boxes[0].colour == static_cast<std::uint32_t>(Colour::kOrange));
  CHECK(read.boxes[0].low == Yuv{98, 0, 166});
  CHECK(read.boxes[0].high == Yuv{255, 94, 255});
  CHECK(colours_text(read) == kGood);
}

TEST_CASE("a file may have boxes for unnamed colours") {
  const std::string text = replaced(kGood, "pink", "other");
  const ColourThresholds read = parse_colours(text, "f");
  CHECK(read.boxes[1].colour == kOtherColour);
  CHECK(colours_text(read) == text);
}

TEST_CASE("invalid threshold files are refused with file name and line") {
  const auto [what, with, line, expected] = GENERATE(table<std::string, std::string, int, std::string>({
      {"rgb", "bgr", 1, "expected yuv422 or rgb, got \"bgr\""},
      {"format: rgb\n", "", 1, "format"},
      {"orange", "oragne", 3, "expected one of field, white"},
      {"[98, 0, 166]", "[98, 0]", 3, "low"},
      {"[98, 0, 166]", "[98, 0, 256]", 3, "0 to 255"},
      {"[98, 0, 166]", "[98.5, 0, 6]", 3, "low"},
      {"[98, 0, 166]", "[98, 95, 166]", 3, "expected no component above that of high"},
      {"low: [0, 1, 2], ", "", 4, "low"},
      {"high: [3, 4, 5]", "high: [3, 4, 5], more: 1", 4, "more"},
  }));
  const std::string text = replaced(kGood, what, with);
  CAPTURE(text);
  try {
    (void)parse_colours(text, "colours.yaml");
    FAIL("accepted");
  } catch (const ConfigError& error) {
    CHECK_THAT(error.what(), StartsWith("colours.yaml:" + std::to_string(line) + ":"));
    CHECK_THAT(error.what(), ContainsSubstring(expected));
  }
}

TEST_CASE("threshold files with no boxes or too many boxes are refused") {
  CHECK_THROWS_AS(parse_colours("format: rgb\nboxes: []\n", "f"), ConfigError);
  std::string many = "format: rgb\nboxes:\n";
  for (int i = 0; i < 33; ++i) many += "  - {colour: pink, low: [0, 1, 2], high: [3, 4, 5]}\n";
  CHECK_THROWS_AS(parse_colours(many, "f"), ConfigError);
}

}  // namespace sidestep::colour_file_test
