// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/idl/idl_parser.hpp"

#include <fmt/format.h>

#include "common/file/temporary_folder.hpp"
#include "common/file/write_file.hpp"
#include "common/messaging/message_schema.hpp"
#include "common/messaging/topics.hpp"
#include "tests/catch.hpp"

namespace sidestep::idl_parser_test {

using Kind = IdlType::Kind;

IdlTypes parse(const std::string& text) { return parse_idl(text, "test.idl"); }

TEST_CASE("structs have the members of the IDL with their types") {
  const IdlTypes types = parse(R"(
    // A comment, and /* another one */
    #pragma once
    module a {
      const long N = 2 * (3 + 1) - 0x2;
      enum Colour { RED, GREEN, @value(7) BLUE, LAST, };
      typedef sequence<double, N> Numbers;
      module b {
        @final struct Base { @key unsigned long long id; string<20> name; };
        @extensibility(MUTABLE) struct Part : Base { octet bytes[2][N], other; };
      };
      @nested @appendable
      struct Whole {
        b::Part part;           /* relative to the module */
        ::a::Colour colour;     // absolute
        Numbers numbers;
        sequence<sequence<string>> texts;
        @optional boolean flag;
        long long _struct;      // an escaped keyword
      };
    };)");
  REQUIRE(types.size() == 4);
  const IdlType& base = *types.at("a::b::Base");
  CHECK(base.extensibility == IdlType::Extensibility::kFinal);
  REQUIRE(base.members.size() == 2);
  CHECK(base.members[0].is_key);
  CHECK(base.members[0].type->kind == Kind::kUint64);
  CHECK(base.members[1].type->bound == 20);

  const IdlType& part = *types.at("a::b::Part");
  CHECK(part.extensibility == IdlType::Extensibility::kMutable);
  REQUIRE(part.members.size() == 4);
  CHECK(part.members[0].name == "id");
  const IdlType& bytes = *part.members[2].type;
  CHECK(bytes.kind == Kind::kArray);
  CHECK(bytes.bound == 2);
  CHECK(bytes.element->bound == 6);
  CHECK(bytes.element->element->kind == Kind::kOctet);
  CHECK(part.members[3].type->kind == Kind::kOctet);

  const IdlType& whole = *types.at("a::Whole");
  CHECK(whole.extensibility == IdlType::Extensibility::kAppendable);
  REQUIRE(whole.members.size() == 6);
  CHECK(whole.members[0].type->name == "a::b::Part");
  CHECK(whole.members[1].type->enumerators ==
        std::map<std::uint32_t, std::string>{{0, "RED"}, {1, "GREEN"}, {7, "BLUE"}, {8, "LAST"}});
  CHECK(whole.members[2].type->bound == 6);
  CHECK(whole.members[3].type->element->element->kind == Kind::kString);
  CHECK(whole.members[4].is_optional);
  CHECK(whole.members[5].name == "struct");
  CHECK(whole.members[5].type->kind == Kind::kInt64);
}

TEST_CASE("the types of all our topics can be parsed") {
  const IdlTypes all = parse(kIdlText);
  for (const TopicInfo& topic : all_topics()) {
    CAPTURE(topic.name);
    const IdlTypes own = parse(message_schema(topic.type.name));
    REQUIRE(own.contains(topic.type.name));
    REQUIRE(all.contains(topic.type.name));
    CHECK(own.at(topic.type.name)->members.size() == all.at(topic.type.name)->members.size());
  }
}

TEST_CASE("an IDL file includes other files relative to its folder, and each file once") {
  const TemporaryFolder folder;
  write_file(folder.file("main.idl"),
             "#include \"parts/a.idl\"\n#include \"b.idl\"\nstruct Main { A a; B b; };");
  write_file(folder.file("b.idl"), "#include \"parts/a.idl\"\n#include \"main.idl\"\nstruct B { A a; };");
  write_file(folder.file("parts/a.idl"), "struct A { long x; };");
  CHECK(load_idl(folder.file("main.idl")).size() == 3);
  write_file(folder.file("c.idl"), "#include \"none.idl\"\n");
  CHECK_THROWS_WITH(load_idl(folder.file("c.idl")), ContainsSubstring("none.idl: cannot be read"));
  CHECK_THROWS_WITH(load_idl(folder.path()), ContainsSubstring("cannot be read"));
}

TEST_CASE("invalid IDL is rejected with the file, the line and the reason") {
  const auto check = [](const std::string& text, const std::string& reason) {
    CAPTURE(text);
    CHECK_THROWS_WITH(parse(text), Equals("test.idl:" + reason));
  };
  check("struct A { long x }", "1: expected ';', got '}'");
  check("struct A {\n\n  Missing x;\n};", "3: there is no type 'Missing', or it is not supported");
  check("struct A { long x;", "1: the text ends in the middle of a definition");
  check("union U switch (long) { case 1: long a; };",
        "1: expected a module, struct, enum, typedef or const, got 'union'");
  check("struct A { wstring x; };", "1: there is no type 'wstring', or it is not supported");
  check("struct A { long x[0]; };", "1: expected a positive number, got 0");
  check("struct A { sequence<long, -1> x; };", "1: expected a positive number, got -1");
  check("struct A { long x[N]; };", "1: expected a whole number or the name of a constant, got 'N'");
  check("const long N = 9223372036854775807 + 1;", "1: a number is too large");
  check("const long N = -9223372036854775807 - 1; const long M = -N;", "1: a number is too large");
  check("struct A : B { long x; };", "1: there is no struct 'B'");
  // A sequence of empty structs could state any number of elements.
  check("struct E {}; struct A { E x[9000000]; };", "1: the elements of a list contain no values");
  check("struct E {}; struct F { E e; }; struct A { sequence<F> x; };",
        "1: the elements of a list contain no values");
  check("/* no end", "1: a comment is not closed");
  check("struct 3 { long x; };", "1: expected a name, got '3'");
  check("enum E { @value(-1) A };", "1: an enumerator's value does not fit 31 bits");
  std::string deep;
  for (int i = 0; i < 200; ++i) deep += "module m { ";
  CHECK_THROWS_WITH(parse(deep), ContainsSubstring("nested too deeply"));
  std::string sequences = "struct A { ";
  for (int i = 0; i < 200; ++i) sequences += "sequence<";
  CHECK_THROWS_WITH(parse(sequences), ContainsSubstring("nested too deeply"));
  std::string dimensions;
  for (int i = 0; i < 200'000; ++i) dimensions += "[1]";
  CHECK_THROWS_WITH(parse("struct A { long x" + dimensions + "; };"),
                    ContainsSubstring("an array has too many dimensions"));
  std::string chain = "typedef sequence<long> T0;", doubling = "struct S0 { octet x; };";
  for (int i = 0; i < 150; ++i) chain += fmt::format("typedef sequence<T{}> T{};", i, i + 1);
  for (int i = 0; i < 40; ++i) doubling += fmt::format("struct S{} {{ S{} a, b; }};\n", i + 1, i);
  CHECK_THROWS_WITH(parse(chain), ContainsSubstring("nested too deeply"));
  check(doubling, "24: a message of this type has 16777216 values, more than 10000000");
  check("struct A { octet x[5000][5000]; };",
        "1: a message of this type has 25000000 values, more than 10000000");
}

}  // namespace sidestep::idl_parser_test
