// SPDX-License-Identifier: Apache-2.0
#include "common/file/xml_text.hpp"

#include "tests/catch.hpp"

namespace sidestep::xml_text_test {

const std::string kInvalid = "\xEF\xBF\xBD";

TEST_CASE("text from strangers cannot leave its place in a picture, page or list of test results") {
  CHECK(xml_escaped("<a b=\"c\" d='e'>&") == "&lt;a b=&quot;c&quot; d=&#39;e&#39;&gt;&amp;");
  CHECK(xml_escaped("line\nnext\ttab\r") == "line&#10;next&#9;tab&#13;");
  CHECK(xml_escaped("gr\xc3\xbc\xc3\x9f, \xe2\x82\xac, \xf0\x9f\xa4\x96") ==
        "gr\xc3\xbc\xc3\x9f, \xe2\x82\xac, \xf0\x9f\xa4\x96");
}

TEST_CASE("what XML cannot contain is replaced") {
  CHECK(xml_escaped(std::string("\0\x1b[K\x7f", 5)) == kInvalid + kInvalid + "[K\x7f");
  CHECK(xml_escaped("\xff \xc3 \xc0\x80") == kInvalid + " " + kInvalid + " " + kInvalid + kInvalid);
  CHECK(xml_escaped("\xed\xa0\x80") == kInvalid + kInvalid + kInvalid);                 // a surrogate
  CHECK(xml_escaped("\xef\xbf\xbf") == kInvalid + kInvalid + kInvalid);                 // a non-character
  CHECK(xml_escaped("\xf4\x90\x80\x80") == kInvalid + kInvalid + kInvalid + kInvalid);  // beyond Unicode
}

}  // namespace sidestep::xml_text_test
