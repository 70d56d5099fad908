// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/url.hpp"

#include "tests/catch.hpp"

namespace sidestep::url_test {

TEST_CASE("the target of a request is decoded") {
  const auto url = parse_target("/api/a%20b?since=3&text=x%3Dy+z&flag&=v");
  REQUIRE(url);
  CHECK(url->path == "/api/a b");
  CHECK(url->query.at("since") == "3");
  CHECK(url->query.at("text") == "x=y z");
  CHECK(url->query.at("flag").empty());
  CHECK(parse_target("/")->query.empty());
}

TEST_CASE("invalid targets are rejected") {
  for (const char* target : {"", "api", "http://host/", "/%", "/%4", "/%zz", "/%00", "/a?b=%g1", "*"})
    CHECK_FALSE(parse_target(target));
}

}  // namespace sidestep::url_test
