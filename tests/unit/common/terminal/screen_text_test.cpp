// SPDX-License-Identifier: Apache-2.0
#include "common/terminal/screen_text.hpp"

#include "tests/catch.hpp"

namespace sidestep::screen_text_test {

TEST_CASE("a line is cut to a number of columns, which colours do not take") {
  CHECK(cut_to("robots", 10) == "robots");
  CHECK(cut_to("robots", 6) == "robots");
  CHECK(cut_to("robots", 3) == "rob");
  CHECK(cut_to("robots", 0) == "");
  CHECK(cut_to("robots", -1) == "");
  CHECK(cut_to("", 5) == "");
  const std::string line = "a " + coloured("silent", TextColour::kRed) + " robot";
  CHECK(columns_of(line) == 14);
  CHECK(cut_to(line, 5) == "a \x1b[31msil\x1b[0m");
  CHECK(columns_of(cut_to(line, 5)) == 5);
  CHECK(coloured("plain", TextColour::kNone) == "plain");
}

TEST_CASE("a cut does not split a character of several bytes") {
  const std::string line = "Jörg's Gerät";
  CHECK(columns_of(line) == 12);
  CHECK(cut_to(line, 2) == "Jö");
  CHECK(cut_to(line, 1) == "J");
  CHECK(columns_of("\xff\xfe!") == 3);
  CHECK(cut_to("\xff\xfe!", 2) == "\xff\xfe");
}

TEST_CASE("parts that do not fit into one line are distributed over several") {
  const std::vector<std::string> parts{"3.5 s", "0 of 5 arrived", "0 contacts", "clearance ?"};
  CHECK(wrapped(parts, 100) == "3.5 s  0 of 5 arrived  0 contacts  clearance ?\n");
  CHECK(wrapped(parts, 46) == "3.5 s  0 of 5 arrived  0 contacts  clearance ?\n");
  CHECK(wrapped(parts, 45) == "3.5 s  0 of 5 arrived  0 contacts\nclearance ?\n");
  CHECK(wrapped(parts, 24) == "3.5 s  0 of 5 arrived\n0 contacts  clearance ?\n");
  CHECK(wrapped(parts, 1) == "3.5 s\n0 of 5 arrived\n0 contacts\nclearance ?\n");
}

TEST_CASE("a text fits on the screen with a column and a row left, and says how many lines it leaves out") {
  CHECK(fitted("one\ntwo\n", {80, 24}) == "one\ntwo\n");
  CHECK(fitted("one\ntwo", {80, 24}) == "one\ntwo\n");
  CHECK(fitted("", {80, 24}) == "");
  CHECK(fitted("robots\n\nrobot\n", {6, 24}) == "robot\n\nrobot\n");
  CHECK(fitted("1\n2\n3\n", {80, 4}) == "1\n2\n3\n");
  CHECK(fitted("1\n2\n3\n4\n", {80, 4}) == "1\n2\n... and 2 more lines\n");
  CHECK(fitted("1\n2\n3\n4\n", {80, 1}) == "... and 4 more lines\n");
}

}  // namespace sidestep::screen_text_test
