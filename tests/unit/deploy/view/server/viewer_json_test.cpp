// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/server/viewer_json.hpp"

#include <nlohmann/json.hpp>

#include "tests/catch.hpp"

namespace sidestep::viewer_json_test {

/// Lists nested to this depth: [[[…]]].
std::string nested(std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

TEST_CASE("JSON messages from viewers are parsed, and other messages are discarded") {
  CHECK(parse_viewer_json(R"({"goals": [[1, 2.5], [3, 4]], "text": "a"})").at("goals")[0][1] == 2.5);
  CHECK(parse_viewer_json("7") == 7);
  for (const char* text : {"", "{", "[1,]", "{} {}", "nul"}) {
    CAPTURE(text);
    CHECK(parse_viewer_json(text).is_discarded());
  }
}

TEST_CASE("deeply nested JSON is discarded") {
  CHECK(parse_viewer_json(nested(16)).is_array());
  CHECK(parse_viewer_json(nested(18)).is_discarded());
  CHECK(parse_viewer_json(R"({"op": "inspect", "channel": )" + nested(32'000) + "}").is_discarded());
  // Elements after the nested lists do not change the result.
  CHECK(parse_viewer_json("[" + nested(100) + ", 1, {}]").is_discarded());
}

}  // namespace sidestep::viewer_json_test
