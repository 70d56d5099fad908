// SPDX-License-Identifier: Apache-2.0
#include "common/file/utf8.hpp"

#include <string>

#include "tests/catch.hpp"

namespace sidestep::utf8_test {

TEST_CASE("the length of a UTF-8 sequence is zero if the sequence is invalid or a control character") {
  const auto [text, length] = GENERATE(table<std::string, std::size_t>({
      {"a", 1},
      {"\t", 1},
      {"\x1b", 0},
      {std::string(1, '\0'), 0},
      {"\xc3\xa4", 2},
      {"\xe4\xba\xa4", 3},
      {"\xf0\x9f\xa4\x96", 4},
      {"\xc3", 0},              // truncated
      {"\xa4", 0},              // a continuation byte
      {"\xc0\x80", 0},          // overlong
      {"\xed\xa0\x80", 0},      // a surrogate
      {"\xef\xbf\xbf", 0},      // a non-character
      {"\xf4\x90\x80\x80", 0},  // beyond Unicode
      {"\xff", 0},
  }));
  CAPTURE(text);
  CHECK(utf8_length(text, 0) == length);
  CHECK(utf8_length("ab" + text, 2) == length);
}

TEST_CASE("a text of unknown origin cannot control a terminal") {
  CHECK(printable_line("robot 3: gr\xc3\xbc\xc3\x9f, \xe4\xba\xa4") ==
        "robot 3: gr\xc3\xbc\xc3\x9f, \xe4\xba\xa4");
  const std::string kInvalid(kReplacementCharacter);
  CHECK(printable_line("a\x1b[2Jb\nc\r\t\x7f") ==
        "a" + kInvalid + "[2Jb" + kInvalid + "c" + kInvalid + kInvalid + kInvalid);
  CHECK(printable_line("\xc2\x9b"
                       "2J\xff") == kInvalid + "2J" + kInvalid);
}

}  // namespace sidestep::utf8_test
