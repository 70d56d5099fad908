// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/message_schema.hpp"

#include "common/messaging/topics.hpp"
#include "tests/catch.hpp"

namespace sidestep {

TEST_CASE("a schema contains only a type and the types that it uses, each after the types it needs") {
  const std::string idl =
      "module a { const long N = 3;\n"
      "@final struct Unused { long x; };\n"
      "module b { enum Kind { ONE, TWO }; @final struct Part { Kind kind; };\n"
      "struct Whole { a::b::Part parts[N]; sequence<double, 4> numbers; };\n"
      "}; };\n"
      "module a { const long N = 3; };\n";
  CHECK(message_schema("a::b::Whole", idl) ==
        "module a { module b { \nenum Kind { ONE, TWO };\n}; }; \n"
        "module a { module b { \n@final struct Part { Kind kind; };\n}; }; \n"
        "module a { \nconst long N = 3;\n}; \n"
        "module a { module b { \nstruct Whole { a::b::Part parts[N]; sequence<double, 4> numbers; };\n}; }; "
        "\n");
  CHECK_THROWS_WITH(message_schema("a::Whole", idl), ContainsSubstring("there is no type a::Whole"));
  CHECK_THROWS_WITH(message_schema("a::b::Nothing", idl), ContainsSubstring("there is no type"));
  for (const char* broken : {"module a {", "module a", "}", "struct A { long a;", "struct A"})
    CHECK_THROWS_AS(message_schema("a::A", broken), std::invalid_argument);
}

TEST_CASE("every topic has a schema") {
  for (const TopicInfo& topic : all_topics()) {
    CAPTURE(topic.name);
    const std::string schema = message_schema(topic.type.name);
    const std::string type = topic.type.name;
    CHECK_THAT(schema, ContainsSubstring("struct " + type.substr(type.rfind(':') + 1) + " {"));
    CHECK_THAT(schema, ContainsSubstring("struct Header {"));
    CHECK(schema.size() < 4000);
  }
}

}  // namespace sidestep
