// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/idl/idl_encoder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "common/json/json_text.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;
using Kind = IdlType::Kind;

class Encoder {
 public:
  explicit Encoder(bool is_little_endian)
      : is_swapped_(is_little_endian != (std::endian::native == std::endian::little)) {}

  /// `json`: nullptr if the member was left out.
  void encode(const IdlType& type, const Json* json, const std::string& name) {
    switch (type.kind) {
      case Kind::kBoolean:
        if (json && !json->is_boolean()) fail(name, "true or false", *json);
        return append<std::uint8_t>(json && json->get<bool>() ? 1 : 0);
      case Kind::kOctet:
        return append_integer<std::uint8_t>(json, name);
      case Kind::kChar:
        if (json && (!json->is_string() || json->get<std::string>().size() != 1))
          fail(name, "a character", *json);
        return append<std::uint8_t>(json ? static_cast<std::uint8_t>(json->get<std::string>()[0]) : 0);
      case Kind::kInt8:
        return append_integer<std::int8_t>(json, name);
      case Kind::kInt16:
        return append_integer<std::int16_t>(json, name);
      case Kind::kInt32:
        return append_integer<std::int32_t>(json, name);
      case Kind::kInt64:
        return append_integer<std::int64_t>(json, name);
      case Kind::kUint16:
        return append_integer<std::uint16_t>(json, name);
      case Kind::kUint32:
        return append_integer<std::uint32_t>(json, name);
      case Kind::kUint64:
        return append_integer<std::uint64_t>(json, name);
      case Kind::kFloat:
        return append(static_cast<float>(real(json, name)));
      case Kind::kDouble:
        return append(real(json, name));
      case Kind::kString:
        return text(type, json, name);
      case Kind::kEnum:
        return enumerator(type, json, name);
      case Kind::kSequence:
      case Kind::kArray:
        return elements(type, json, name);
      case Kind::kStruct:
        return members(type, json, name);
    }
  }

  /// Encodes the key members of a struct, or all its members if none is a key.
  void encode_key(const IdlType& type, const Json* json, const std::string& name) {
    const bool has_keys = std::ranges::any_of(type.members, &IdlMember::is_key);
    for (const IdlMember& member : type.members) {
      if (has_keys && !member.is_key) continue;
      const Json* value = find(json, member.name);
      const std::string path = name + member.name;
      if (member.type->kind == Kind::kStruct)
        encode_key(*member.type, value, path + ".");
      else
        encode(*member.type, value, path);
    }
  }

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  [[noreturn]] static void fail(const std::string& name, const std::string& expected, const Json& json) {
    throw IdlEncodingError(fmt::format("{}: expected {}, got {}", name.empty() ? "the message" : name,
                                       expected, json_text(json).substr(0, 60)));
  }

  static const Json* find(const Json* json, const std::string& name) {
    if (!json) return nullptr;
    const auto found = json->find(name);
    return found == json->end() ? nullptr : &*found;
  }

  template <typename Number>
  void append(Number number) {
    while (bytes_.size() % sizeof(Number) != 0) bytes_.push_back(0);
    auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(Number)>>(number);
    if (is_swapped_) std::ranges::reverse(raw);
    std::ranges::copy(raw, std::back_inserter(bytes_));
  }

  template <typename Number>
  void append_integer(const Json* json, const std::string& name) {
    if (!json) return append(Number{0});
    using Limits = std::numeric_limits<Number>;
    const bool fits = json->is_number_unsigned()
                          ? std::in_range<Number>(json->get<std::uint64_t>())
                          : json->is_number_integer() && std::in_range<Number>(json->get<std::int64_t>());
    if (!fits) fail(name, fmt::format("a whole number from {} to {}", +Limits::min(), +Limits::max()), *json);
    append(json->get<Number>());
  }

  static double real(const Json* json, const std::string& name) {
    if (!json) return 0;
    if (json->is_null()) return std::nan("");  // JSON's form of NaN and infinity
    if (!json->is_number()) fail(name, "a number", *json);
    return json->get<double>();
  }

  void text(const IdlType& type, const Json* json, const std::string& name) {
    if (json && !json->is_string()) fail(name, "a text", *json);
    const std::string value = json ? json->get<std::string>() : std::string();
    if (type.bound != 0 && value.size() > type.bound)
      fail(name, fmt::format("at most {} bytes", type.bound), *json);
    append(static_cast<std::uint32_t>(value.size() + 1));
    std::ranges::copy(value, std::back_inserter(bytes_));
    bytes_.push_back(0);
  }

  void enumerator(const IdlType& type, const Json* json, const std::string& name) {
    if (!json) return append(type.enumerators.empty() ? 0u : type.enumerators.begin()->first);
    if (json->is_number_unsigned())
      return append_integer<std::uint32_t>(json, name);  // possibly not the value of an enumerator
    std::string known;
    for (const auto& [value, word] : type.enumerators) {
      if (*json == word) return append(value);
      known += (known.empty() ? "" : ", ") + word;
    }
    fail(name, "one of " + known, *json);
  }

  void elements(const IdlType& type, const Json* json, const std::string& name) {
    const bool is_array = type.kind == Kind::kArray;
    const std::size_t given = json && json->is_array() ? json->size() : 0;
    const bool fits = !json || (json->is_array() && (type.bound == 0 || given <= type.bound));
    if (!fits)
      fail(name, type.bound == 0 ? "a list" : fmt::format("a list of at most {} elements", type.bound),
           *json);
    if (!is_array) append(static_cast<std::uint32_t>(given));
    for (std::size_t i = 0; i < (is_array ? type.bound : given); ++i)
      encode(*type.element, i < given ? &(*json)[i] : nullptr, fmt::format("{}[{}]", name, i));
  }

  void members(const IdlType& type, const Json* json, const std::string& name) {
    if (type.extensibility == IdlType::Extensibility::kMutable)
      throw IdlEncodingError(type.name + " is mutable, which is not supported");
    const std::string prefix = name.empty() ? "" : name + ".";
    if (json) {
      if (!json->is_object()) fail(name, "an object", *json);
      for (const auto& item : json->items())
        if (std::ranges::none_of(type.members,
                                 [&](const IdlMember& member) { return member.name == item.key(); }))
          throw IdlEncodingError(fmt::format("{}{}: {} has no such member", prefix, item.key(), type.name));
    }
    for (const IdlMember& member : type.members) {
      if (member.is_optional)
        throw IdlEncodingError(fmt::format("{}{} is optional, which is not supported", prefix, member.name));
      encode(*member.type, find(json, member.name), prefix + member.name);
    }
  }

  std::vector<std::uint8_t> bytes_;
  bool is_swapped_;
};

}  // namespace

std::vector<std::uint8_t> encode_by_idl(const IdlType& type, const Json& json) {
  Encoder encoder(true);
  encoder.encode(type, &json, "");
  std::vector<std::uint8_t> bytes{0, 1, 0, 0};  // "CDR, little-endian"
  bytes.reserve(bytes.size() + encoder.bytes().size());
  std::ranges::copy(encoder.bytes(), std::back_inserter(bytes));
  return bytes;
}

bool is_keyed(const IdlType& type) { return std::ranges::any_of(type.members, &IdlMember::is_key); }

CdrKey key_by_idl(const IdlType& type, const Json& json) {
  CdrKey key{};
  if (!is_keyed(type)) return key;
  Encoder encoder(false);
  encoder.encode_key(type, &json, "");
  if (encoder.bytes().size() > key.size())
    throw IdlEncodingError("the key members need more than 16 bytes, which is not supported");
  std::ranges::copy(encoder.bytes(), key.begin());
  return key;
}

}  // namespace sidestep
