// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/idl/idl_encoder.hpp"

#include "common/json/json_text.hpp"
#include "common/messaging/message_schema.hpp"
#include "deploy/inspect/topic/idl/idl_decoder.hpp"
#include "deploy/inspect/topic/idl/idl_parser.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::idl_encoder_test {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

TEST_CASE("our messages and their keys are encoded by IDL exactly as by the generated code") {
  const IdlTypes types = parse_idl(kIdlText, "idl");
  Rng rng(7);
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    CAPTURE(topic.name);
    const IdlType& type = *types.at(topic.type.name);
    CHECK(is_keyed(type));
    for (std::uint32_t i = 0; i < 20; ++i) {
      const auto elements = static_cast<std::uint32_t>(std::min<std::size_t>(i % 5, topic.type.max_elements));
      const auto message = random_message<Message>(rng, topic.type.max_elements > 0, elements);
      Bytes bytes{0, 1, 0, 0};
      append_cdr(topic, &message, bytes);
      const Json json = decode_by_idl(type, bytes);
      // Compared as JSON, because a signalling NaN of the random message becomes a quiet NaN.
      CHECK(json_text(decode_by_idl(type, encode_by_idl(type, json))) == json_text(json));
      CHECK(encode_by_idl(type, json).size() == bytes.size());
      CHECK(key_by_idl(type, json) == topic.type.cdr_key(&message));
    }
  });
}

const IdlTypes kTypes = parse_idl(
    "enum E { ONE, TWO }; @final struct P { double x; }; @final struct T { @key octet a; @key long long b; "
    "string<3> s; E "
    "e; sequence<P, 2> p; octet n[2]; boolean f; char c; short i; };",
    "test.idl");

TEST_CASE("members that the JSON omits are encoded as zero") {
  CHECK(encode_by_idl(*kTypes.at("P"), Json::object()) == Bytes{0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const Json all = decode_by_idl(*kTypes.at("T"), encode_by_idl(*kTypes.at("T"), Json::object()));
  CHECK(all == Json{{"a", 0},
                    {"b", 0},
                    {"s", ""},
                    {"e", "ONE"},
                    {"p", Json::array()},
                    {"n", {0, 0}},
                    {"f", false},
                    {"c", std::string(1, '\0')},
                    {"i", 0}});
}

TEST_CASE("the key is encoded from the key members, big-endian and aligned") {
  const auto key = key_by_idl(*kTypes.at("T"), {{"a", 5}, {"b", 258}, {"s", "x"}});
  CHECK(key == CdrKey{5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2});
  CHECK_FALSE(is_keyed(*kTypes.at("P")));
  const IdlTypes long_key = parse_idl("@final struct T { @key double a, b, c; };", "test.idl");
  CHECK_THROWS_WITH(key_by_idl(*long_key.at("T"), Json::object()), ContainsSubstring("more than 16 bytes"));
}

TEST_CASE("the reason for a rejected value is reported even if the value is invalid UTF-8") {
  CHECK_THROWS_AS(encode_by_idl(*kTypes.at("T"), {{"b", "\xff"}}), IdlEncodingError);
}

TEST_CASE("JSON that does not fit the message type is rejected with the member's name") {
  const auto check = [](const Json& json, const std::string& reason) {
    CHECK_THROWS_WITH(encode_by_idl(*kTypes.at("T"), json), ContainsSubstring(reason));
  };
  check(3, "the message: expected an object, got 3");
  check({{"z", 1}}, "z: T has no such member");
  check({{"a", 256}}, "a: expected a whole number from 0 to 255, got 256");
  check({{"a", -1}}, "a: expected a whole number");
  check({{"a", 1.5}}, "a: expected a whole number");
  check({{"i", -32769}}, "i: expected a whole number from -32768 to 32767");
  check({{"s", "four"}}, "s: expected at most 3 bytes");
  check({{"s", 1}}, "s: expected a text");
  check({{"e", "THREE"}}, "e: expected one of ONE, TWO");
  check({{"p", {{{"x", 1}}, {{"x", 1}}, {{"x", 1}}}}}, "p: expected a list of at most 2 elements");
  check({{"p", {{{"y", 1}}}}}, "p[0].y: P has no such member");
  check({{"p", {{{"x", "1"}}}}}, "p[0].x: expected a number");
  check({{"n", {1, 2, 3}}}, "n: expected a list of at most 2 elements");
  check({{"f", 1}}, "f: expected true or false");
  check({{"c", "ab"}}, "c: expected a character");
}

}  // namespace sidestep::idl_encoder_test
