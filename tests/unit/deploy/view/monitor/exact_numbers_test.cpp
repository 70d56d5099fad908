// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/exact_numbers.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "deploy/inspect/topic/describe.hpp"
#include "deploy/view/monitor/inspected_message.hpp"
#include "tests/catch.hpp"

namespace sidestep::exact_numbers_test {

using Json = nlohmann::ordered_json;

Json exact(Json json) {
  make_numbers_exact(json);
  return json;
}

TEST_CASE("whole numbers that JavaScript would round become text, and others stay numbers") {
  CHECK(exact(9'007'199'254'740'991) == 9'007'199'254'740'991);
  CHECK(exact(9'007'199'254'740'992) == "9007199254740992");
  CHECK(exact(-9'007'199'254'740'991) == -9'007'199'254'740'991);
  CHECK(exact(-9'007'199'254'740'992) == "-9007199254740992");
  CHECK(exact(std::numeric_limits<std::uint64_t>::max()) == "18446744073709551615");
  CHECK(exact(std::numeric_limits<std::int64_t>::min()) == "-9223372036854775808");
  CHECK(exact(1e300) == 1e300);
  CHECK(exact("1") == "1");
  CHECK(exact(nullptr).is_null());
  CHECK(json_text(exact(Json{{"a", {1, 1'795'630'117'800'000'001, {{"b", 1ULL << 63}}}}, {"c", true}})) ==
        R"({"a":[1,"1795630117800000001",{"b":"9223372036854775808"}],"c":true})");
}

TEST_CASE("the inspector gets incarnations and stamps exactly") {
  msg::AgentStatus status;
  status.robot(3);
  status.header().incarnation(1'795'630'117'800'000'001);
  status.header().message_number(12);
  status.header().stamp_ns(1'795'630'117'800'000'003);
  const Json entry =
      parse_ordered_json(inspected_message(time_from_ns(1'500'000'000), describe(topics::kStatus, &status)));
  CHECK(entry.at("at_s") == 1.5);
  CHECK(entry.at("message").at("header").at("incarnation") == "1795630117800000001");
  CHECK(entry.at("message").at("header").at("stamp_ns") == "1795630117800000003");
  CHECK(entry.at("message").at("header").at("message_number") == 12);
}

}  // namespace sidestep::exact_numbers_test
