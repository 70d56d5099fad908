// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/zone_text.hpp"

#include "common/messaging/order_codec.hpp"
#include "common/process/command_line.hpp"
#include "tests/catch.hpp"

namespace sidestep::zone_text_test {

TEST_CASE("a zone needs corners, and also a radius if the corners enclose no area") {
  const Zone disc = parse_zone({"1,-2"}, 0.3, std::nullopt);
  REQUIRE(disc.corners_m.size() == 1);
  CHECK(disc.corners_m[0] == Vec2(1, -2));
  CHECK(disc.radius_m == 0.3);
  CHECK_FALSE(disc.speed_limit_mps);
  CHECK(parse_zone({"0,0", "1,0", "1,1"}, 0, 0.5).speed_limit_mps == 0.5);
  CHECK(parse_zone({"0,0", "1,0"}, 0.1, std::nullopt).corners_m.size() == 2);
  CHECK_THROWS_WITH(parse_zone({}, 1, std::nullopt), ContainsSubstring("CORNER is missing"));
  CHECK_THROWS_WITH(parse_zone({"1,-2"}, 0, std::nullopt), ContainsSubstring("no area"));
  CHECK_THROWS_WITH(parse_zone({"0,0", "1,0"}, 0, std::nullopt), ContainsSubstring("no area"));
  CHECK_THROWS_WITH(parse_zone({"0,0", "1,1", "2,2", "-1,-1"}, 0, std::nullopt),
                    ContainsSubstring("no area"));
  CHECK_THROWS_WITH(parse_zone({"1,1", "1,1", "1,1"}, 0, std::nullopt), ContainsSubstring("no area"));
  const std::vector<std::string> most(kMaxZoneCorners, "1,1"), too_many(kMaxZoneCorners + 1, "1,1");
  CHECK(parse_zone(most, 1, std::nullopt).corners_m.size() == kMaxZoneCorners);
  CHECK_THROWS_WITH(parse_zone(too_many, 1, std::nullopt), ContainsSubstring("at most 16 corners"));
}

TEST_CASE("a corner of a zone is given by two coordinates") {
  for (const char* text : {"", "1", "1,", ",1", "1,2,3", "1;2", "nan,1", "1,inf", "1e9,0", "1,2 "}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_zone({text}, 1, std::nullopt), UsageError);
  }
}

}  // namespace sidestep::zone_text_test
