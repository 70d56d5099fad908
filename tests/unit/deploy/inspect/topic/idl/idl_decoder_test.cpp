// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/idl/idl_decoder.hpp"

#include "common/messaging/message_schema.hpp"
#include "deploy/inspect/topic/describe.hpp"
#include "deploy/inspect/topic/idl/idl_parser.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"
#include "tests/unit/deploy/inspect/topic/compare_described.hpp"

namespace sidestep::idl_decoder_test {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

Json decode(const std::string& idl, const Bytes& bytes) {
  return decode_by_idl(*parse_idl(idl, "test.idl").at("T"), bytes);
}

TEST_CASE("messages of our topics are decoded by their IDL exactly as by the generated code") {
  const IdlTypes types = parse_idl(kIdlText, "idl");
  Rng rng(5);
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    CAPTURE(topic.name);
    for (std::uint32_t i = 0; i < 20; ++i) {
      const auto elements = static_cast<std::uint32_t>(std::min<std::size_t>(i % 5, topic.type.max_elements));
      const auto message = random_message<Message>(rng, topic.type.max_elements > 0, elements);
      Bytes bytes{0, 1, 0, 0};
      append_cdr(topic, &message, bytes);
      const Json decoded = decode_by_idl(*types.at(topic.type.name), bytes);
      require_same_fields(describe(topic, &message), decoded);
      CHECK(decoded["header"]["stamp_ns"] == message.header().stamp_ns());
      for (std::size_t size = 0; size + 4 < bytes.size(); size += 1 + size / 8)
        REQUIRE_THROWS_AS(decode_by_idl(*types.at(topic.type.name), std::span(bytes).first(size)),
                          IdlDecodingError);
    }
  });
}

TEST_CASE("both byte orders and both versions of the encoding are decoded") {
  const std::string idl = "@final struct T { octet a; double b; };";
  const Json expected = {{"a", 5}, {"b", 1.5}};
  CHECK(decode(idl, {0, 1, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xf8, 0x3f}) == expected);
  CHECK(decode(idl, {0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0x3f, 0xf8, 0, 0, 0, 0, 0, 0}) == expected);
  // Encoding version 2 aligns to at most 4 bytes.
  CHECK(decode(idl, {0, 7, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xf8, 0x3f}) == expected);
  CHECK(decode(idl, {0, 6, 0, 0, 5, 0, 0, 0, 0x3f, 0xf8, 0, 0, 0, 0, 0, 0}) == expected);
}

TEST_CASE("the sizes of structs and sequences in encoding version 2 are skipped") {
  // An appendable struct and a sequence of structs begin with their size; a sequence of numbers does not.
  const std::string idl =
      "@final struct P { octet x; }; @appendable struct T { sequence<P> parts; octet raw[2]; };";
  CHECK(decode(idl, {0, 9, 0, 0, 14, 0, 0, 0, 6, 0, 0, 0, 2, 0, 0, 0, 7, 8, 1, 2}) ==
        Json{{"parts", {{{"x", 7}}, {{"x", 8}}}}, {"raw", {1, 2}}});
}

TEST_CASE("text, enumerators and nested arrays are decoded") {
  const std::string idl =
      "enum E { ONE, TWO }; @final struct T { string s; E known, unknown; octet a[2][2]; char c; };";
  CHECK(decode(idl, {0, 1, 0, 0, 3, 0, 0, 0, 'h', 'i', 0, 0, 1, 0, 0, 0, 9, 0, 0, 0, 1, 2, 3, 4, 'c'}) ==
        Json{{"s", "hi"}, {"known", "TWO"}, {"unknown", 9}, {"a", {{1, 2}, {3, 4}}}, {"c", "c"}});
}

TEST_CASE("on request octet sequences are decoded to text, and long or unbounded sequences to their size") {
  const IdlTypes types = parse_idl(
      "@final struct T { octet a[2]; sequence<octet, 65536> b, c; sequence<octet, 65537> d; sequence<octet> "
      "e; "
      "};",
      "idl");
  const Bytes bytes{0, 1, 0, 0, 1, 2, 0, 0, 3, 0, 0, 0, 'h', 'i', '\n', 0, 0,
                    0, 0, 0, 2, 0, 0, 0, 8, 9, 0, 0, 1, 0,   0,   0,    7};
  const Json decoded = decode_by_idl(*types.at("T"), bytes, OctetSequences::kText);
  CHECK(decoded == Json{{"a", {1, 2}}, {"b", "hi\n"}, {"c", ""}, {"d", "2 bytes"}, {"e", "1 bytes"}});
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(decode_by_idl(*types.at("T"), std::span(bytes).first(size), OctetSequences::kText),
                    IdlDecodingError);
}

TEST_CASE("bytes that are not a message are refused even if they state huge sizes") {
  const std::string idl = "@final struct T { sequence<octet, 4> a; string<3> s; };";
  const auto check = [](const std::string& text, const Bytes& bytes, const std::string& reason) {
    CAPTURE(reason);
    CHECK_THROWS_WITH(decode(text, bytes), ContainsSubstring(reason));
  };
  check(idl, {0, 1, 0}, "the encapsulation header is missing");
  check(idl, {0, 3, 0, 0}, "the encoding 0x0003 is not supported");
  check(idl, {0, 1, 0, 0, 1, 0}, "too early");
  check(idl, {0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff, 1, 2, 3, 4}, "a sequence claims a size of 4294967295");
  check(idl, {0, 1, 0, 0, 5, 0, 0, 0, 1, 2, 3, 4, 5, 0, 0, 0}, "a sequence claims a size of 5");
  check(idl, {0, 1, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 'a', 'b', 'c', 'd', 0}, "a string claims a size of 5");
  Bytes many(4 + 4 + 0x00a00000);
  many[1] = 1, many[4 + 2] = 0xa0;
  check("@final struct T { sequence<octet> many; };", many, "too many elements");
  check("@mutable struct T { long a; };", {0, 1, 0, 0, 0, 0, 0, 0}, "T is mutable");
  check("@final struct T { @optional long a; };", {0, 1, 0, 0, 0, 0, 0, 0}, "T.a is optional");
  const IdlTypePtr type = parse_idl(
                              "@appendable struct P { string s; sequence<long> l; }; @final struct T { "
                              "sequence<P> parts; string s; sequence<sequence<double>> d; };",
                              "idl")
                              .at("T");
  for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
    Rng rng(seed);
    Bytes bytes(rng.below(80));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng.chance(0.7) ? 0 : rng.below(12));
    try {
      (void)decode_by_idl(*type, bytes);
    } catch (const IdlDecodingError&) {
    }
  }
}

}  // namespace sidestep::idl_decoder_test
