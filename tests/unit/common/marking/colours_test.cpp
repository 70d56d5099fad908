// SPDX-License-Identifier: Apache-2.0
#include "common/marking/colours.hpp"

#include <set>

#include "tests/catch.hpp"

namespace sidestep::colours_test {

TEST_CASE("every colour has its own index and name") {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    CHECK(static_cast<std::size_t>(kColours[i].colour) == i);
    CHECK(names.insert(kColours[i].name).second);
    CHECK(colour_named(kColours[i].name) == kColours[i].colour);
    CHECK(named(kColours[i].colour).name == kColours[i].name);
  }
  CHECK(!colour_named("beige"));
  CHECK(!colour_named(""));
}

TEST_CASE("colours are converted to YUV as in BT.601 and survive the conversion back within rounding") {
  CHECK(yuv_of({255, 255, 255}) == Yuv{255, 128, 128});
  CHECK(yuv_of({0, 0, 0}) == Yuv{0, 128, 128});
  CHECK(yuv_of({255, 0, 0}) == Yuv{76, 85, 255});
  CHECK(yuv_of({0, 255, 0}) == Yuv{150, 44, 21});
  CHECK(yuv_of({0, 0, 255}) == Yuv{29, 255, 107});
  for (int r = 0; r < 256; r += 5) {
    for (int g = 0; g < 256; g += 5) {
      for (int b = 0; b < 256; b += 5) {
        const Rgb c{static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(b)};
        const Rgb back = rgb_of(yuv_of(c));
        REQUIRE(std::abs(back.r - c.r) <= 2);
        REQUIRE(std::abs(back.g - c.g) <= 2);
        REQUIRE(std::abs(back.b - c.b) <= 2);
      }
    }
  }
}

TEST_CASE("a camera can distinguish any two colours") {
  for (const NamedColour& a : kColours) {
    for (const NamedColour& b : kColours) {
      if (a.colour >= b.colour) continue;
      const Yuv p = yuv_of(a.rgb), q = yuv_of(b.rgb);
      CAPTURE(a.name, b.name);
      CHECK(std::hypot(p.y - q.y, p.u - q.u, p.v - q.v) > 45);
    }
  }
}

}  // namespace sidestep::colours_test
