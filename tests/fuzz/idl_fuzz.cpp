// SPDX-License-Identifier: Apache-2.0
// Fuzzes the reader of IDL and the decoder of messages whose types it
// defines. An input is IDL, a zero byte, and a message.
#include <algorithm>

#include "common/json/json_text.hpp"
#include "common/messaging/message_schema.hpp"
#include "deploy/inspect/topic/idl/idl_decoder.hpp"
#include "deploy/inspect/topic/idl/idl_encoder.hpp"
#include "deploy/inspect/topic/idl/idl_parser.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace sidestep::fuzz {
namespace {

using Json = nlohmann::ordered_json;
using Kind = IdlType::Kind;

constexpr int kMaxDepth = 100;

void check(const IdlType& type, int depth) {
  SIDESTEP_REQUIRE(depth <= kMaxDepth && type.depth <= kMaxDepth);
  const bool is_list = type.kind == Kind::kSequence || type.kind == Kind::kArray;
  SIDESTEP_REQUIRE(is_list == (type.element != nullptr));
  SIDESTEP_REQUIRE(type.kind != Kind::kArray || type.bound > 0);
  if (is_list) check(*type.element, depth + 1);
  for (const IdlMember& member : type.members) {
    SIDESTEP_REQUIRE(!member.name.empty() && member.type != nullptr && member.type->depth < type.depth);
    check(*member.type, depth + 1);
  }
}

/// Encodes a decoded message. Decoding the result must give the same message.
void check_again(const IdlType& type, const Json& json) {
  try {
    const Bytes bytes = encode_by_idl(type, json);
    SIDESTEP_REQUIRE(encode_by_idl(type, decode_by_idl(type, bytes)) == bytes);
    if (is_keyed(type)) (void)key_by_idl(type, json);
  } catch (const IdlEncodingError&) {
    // Unknown enumerators, which are decoded to numbers, and keys that are too long cannot be encoded.
  }
}

/// Returns whether the bytes are a message of the type.
bool try_message(const IdlType& type, View bytes) {
  try {
    const Json json = decode_by_idl(type, bytes);
    (void)json_text(json);
    check_again(type, json);
    return true;
  } catch (const IdlDecodingError&) {
    return false;
  }
}

Bytes input_of(std::string_view idl, const Bytes& message) {
  Bytes input = bytes_of(idl);
  input.push_back(0);
  input.insert(input.end(), message.begin(), message.end());
  return input;
}

}  // namespace

bool try_input(View input) {
  const auto end = std::ranges::find(input, 0);
  const View message(end == input.end() ? end : end + 1, input.end());
  try {
    const IdlTypes types = parse_idl(text_of({input.begin(), end}), "fuzz.idl");
    bool has_message = false;
    for (const auto& [name, type] : types) {
      SIDESTEP_REQUIRE(type->name == name);
      check(*type, 1);
      has_message = try_message(*type, message) || has_message;
    }
    return has_message;
  } catch (const IdlError& error) {
    SIDESTEP_REQUIRE(std::string_view(error.what()).starts_with("fuzz.idl:"));
    return false;
  }
}

std::vector<Bytes> seeds() {
  std::vector<Bytes> result;
  // Messages of all kinds of types, empty or full of zeros.
  Bytes zeros(200);
  for (const std::uint8_t encoding : {0, 1, 6, 7, 8, 9}) {
    zeros[1] = encoding;
    for (const char* type : {"Order", "Header", "Verdict", "LaserScan", "ClockReply"}) {
      try {
        result.push_back(input_of(message_schema(std::string("sidestep::msg::") + type), zeros));
      } catch (const std::invalid_argument&) {
      }
    }
    result.push_back(input_of(R"(module a {
  const long N = 2 * (3 - 1) + 0x1;
  enum Colour { @value(3) RED, GREEN };
  typedef sequence<octet, N> Bytes;
  @appendable struct Base { @key long id; };
  @final struct All : Base {
    boolean b; char c; int8 i; short s; unsigned short us; long long ll; unsigned long long ull;
    float f; double d; string<8> text; Colour colour; Bytes bytes; long grid[2][N]; sequence<Base> bases;
  };
};)",
                              zeros));
  }
  std::erase_if(result, [](const Bytes& input) { return !try_input(input); });
  return result;
}

}  // namespace sidestep::fuzz
