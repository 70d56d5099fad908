// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/message_printer.hpp"

#include <stdexcept>

#include "common/json/json_text.hpp"
#include "tests/catch.hpp"

namespace sidestep::message_printer_test {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

const Json kMessage = {{"robot", 3},
                       {"header", {{"sender", 7}, {"rules", "00ff"}}},
                       {"name", "a, \"b\""},
                       {"positions", {{{"x_m", 0.5}}, {{"x_m", 1.5}}}}};

/// The lines for this message, and for the same message from robots 4 and 5.
Lines print(const std::vector<std::string>& filters, bool is_csv = false, std::uint64_t count = 0) {
  MessagePrinterSettings settings{{}, is_csv, count};
  for (const std::string& filter : filters) settings.filters.push_back(parse_message_filter(filter));
  Lines lines;
  MessagePrinter printer(settings, [&](const std::string& line) { lines.push_back(line); });
  Json message = kMessage;
  for (int robot = 3; robot <= 5; ++robot) {
    message["robot"] = robot;
    printer.print_if_wanted(message);
  }
  return lines;
}

TEST_CASE("messages are printed as JSON, one per line") {
  const Lines lines = print({});
  REQUIRE(lines.size() == 3);
  CHECK(parse_ordered_json(lines[0]) == kMessage);
  CHECK(print({}, false, 2).size() == 2);
}

TEST_CASE("CSV has a column for each member, and lists are printed as JSON") {
  CHECK(print({}, true, 2) == Lines{"robot,header.sender,header.rules,name,positions",
                                    "3,7,00ff,\"a, \"\"b\"\"\",\"[{\"\"x_m\"\":0.5},{\"\"x_m\"\":1.5}]\"",
                                    "4,7,00ff,\"a, \"\"b\"\"\",\"[{\"\"x_m\"\":0.5},{\"\"x_m\"\":1.5}]\""});
}

TEST_CASE("only messages that match all filters are printed") {
  CHECK(print({"robot=4"}).size() == 1);
  CHECK(print({"robot=9"}).empty());
  CHECK(print({"header.sender=7"}).size() == 3);
  CHECK(print({"header.rules=00ff", "robot=5"}).size() == 1);
  CHECK(print({"header.sender=7", "robot=9"}).empty());
  CHECK(print({"positions.1.x_m=1.5"}).size() == 3);
  CHECK(print({"positions.2.x_m=1.5"}).empty());
  CHECK(print({"name=a, \"b\""}).size() == 3);
}

TEST_CASE("a filter that fits no message is rejected with a list of the members") {
  CHECK_THROWS_WITH(print({"robto=3"}),
                    "there is no member 'robto', expected one of: robot, header, name, positions");
  CHECK_THROWS_WITH(print({"header.x=3"}), ContainsSubstring("expected one of: sender, rules"));
  CHECK_THROWS_WITH(print({"robot.x=3"}), ContainsSubstring("expected one of: none"));
  CHECK_THROWS_WITH(print({"positions.x=3"}), ContainsSubstring("'x' is not the index of an element"));
  for (const char* text : {"robot", "=3", ""})
    CHECK_THROWS_WITH(parse_message_filter(text), ContainsSubstring("is not MEMBER=VALUE"));
}

}  // namespace sidestep::message_printer_test
