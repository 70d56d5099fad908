// SPDX-License-Identifier: Apache-2.0
#include "common/svg/palette.hpp"

#include <set>

#include "tests/catch.hpp"

namespace sidestep::palette_test {

TEST_CASE("the contrast of colours is that of WCAG") {
  CHECK(contrast("#ffffff", "#000000") == Approx(21));
  CHECK(contrast("#777777", "#ffffff") == Approx(4.48).margin(0.01));
  CHECK(contrast("#ffffff", "#777777") == contrast("#777777", "#ffffff"));
  CHECK(contrast("#123456", "#123456") == Approx(1));
}

TEST_CASE("a thousand robots have different colours, on each of which white numbers are legible") {
  std::set<std::string> colours;
  for (std::size_t i = 0; i < 1000; ++i) {
    const std::string colour = distinct_colour(i);
    CAPTURE(i, colour);
    CHECK(colour.size() == 7);
    CHECK(contrast(colour, "#ffffff") >= 4.5);
    colours.insert(colour);
    if (i < 64) CHECK(colours.size() == i + 1);
  }
  CHECK(colours.size() > 400);
}

}  // namespace sidestep::palette_test
