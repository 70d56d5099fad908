// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/idl/idl_decoder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>
#include <string>

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;
using Kind = IdlType::Kind;

/// Limit, because nested arrays may claim far more elements than the message has bytes.
constexpr std::size_t kMaxElements = 10'000'000;
constexpr std::uint32_t kMaxTextBound = 1 << 16;

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> bytes, OctetSequences octets) : octets_(octets) {
    if (bytes.size() < 4) throw IdlDecodingError("the encapsulation header is missing");
    const unsigned encoding = bytes[0] * 256u + bytes[1];
    switch (encoding) {
      case 0x0000:
      case 0x0001:
        break;
      case 0x0006:
      case 0x0007:
        is_version_2_ = true;
        break;
      case 0x0008:
      case 0x0009:
        is_version_2_ = is_delimited_ = true;
        break;
      default:
        throw IdlDecodingError(fmt::format("the encoding {:#06x} is not supported", encoding));
    }
    const bool is_little_endian = (encoding & 1) != 0;
    is_swapped_ = is_little_endian != (std::endian::native == std::endian::little);
    bytes_ = bytes.subspan(4);
  }

  Json decode(const IdlType& type) {
    switch (type.kind) {
      case Kind::kBoolean:
        return number<std::uint8_t>() != 0;
      case Kind::kOctet:
        return number<std::uint8_t>();
      case Kind::kChar:
        return std::string(1, static_cast<char>(number<std::uint8_t>()));
      case Kind::kInt8:
        return number<std::int8_t>();
      case Kind::kInt16:
        return number<std::int16_t>();
      case Kind::kInt32:
        return number<std::int32_t>();
      case Kind::kInt64:
        return number<std::int64_t>();
      case Kind::kUint16:
        return number<std::uint16_t>();
      case Kind::kUint32:
        return number<std::uint32_t>();
      case Kind::kUint64:
        return number<std::uint64_t>();
      case Kind::kFloat:
        return number<float>();
      case Kind::kDouble:
        return number<double>();
      case Kind::kString:
        return text(type);
      case Kind::kEnum:
        return enumerator(type);
      case Kind::kSequence:
        return sequence(type);
      case Kind::kArray:
        skip_delimiter(innermost(type));
        return array(type);
      case Kind::kStruct:
        return members(type);
    }
    throw IdlDecodingError("unknown type");
  }

 private:
  template <typename Number>
  Number number() {
    const std::size_t alignment = is_version_2_ ? std::min<std::size_t>(sizeof(Number), 4) : sizeof(Number);
    at_ = (at_ + alignment - 1) / alignment * alignment;
    if (at_ > bytes_.size() || bytes_.size() - at_ < sizeof(Number))
      throw IdlDecodingError(fmt::format("the message ends too early, after {} bytes", bytes_.size()));
    std::array<std::uint8_t, sizeof(Number)> raw;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), sizeof(Number), raw.begin());
    if (is_swapped_) std::ranges::reverse(raw);
    at_ += sizeof(Number);
    return std::bit_cast<Number>(raw);
  }

  std::uint32_t count(std::uint32_t bound, const char* what) {
    const auto size = number<std::uint32_t>();
    if (size > bytes_.size() - at_ || (bound != 0 && size > bound))
      throw IdlDecodingError(fmt::format("a {} claims a size of {}", what, size));
    return size;
  }

  Json text(const IdlType& type) {
    const std::uint32_t size =
        count(type.bound == 0 ? 0 : type.bound + 1, "string");  // including the final zero
    std::string result(reinterpret_cast<const char*>(bytes_.data()) + at_, size);
    at_ += size;
    if (!result.empty() && result.back() == '\0') result.pop_back();
    return result;
  }

  Json enumerator(const IdlType& type) {
    const auto value = number<std::uint32_t>();
    const auto found = type.enumerators.find(value);
    return found == type.enumerators.end() ? Json(value) : Json(found->second);
  }

  /// Skips the size that CDR version 2 states before sequences and arrays whose elements are not primitive.
  void skip_delimiter(const IdlType& element) {
    const bool is_primitive = element.kind < Kind::kString;
    if (is_version_2_ && !is_primitive) number<std::uint32_t>();
  }

  Json sequence(const IdlType& type) {
    skip_delimiter(*type.element);
    const std::uint32_t size = count(type.bound, "sequence");
    if (type.element->kind != Kind::kOctet || octets_ == OctetSequences::kNumbers)
      return elements(*type.element, size);
    const char* const first = reinterpret_cast<const char*>(bytes_.data()) + at_;
    at_ += size;
    const bool is_text = type.bound != 0 && type.bound <= kMaxTextBound;
    return is_text ? std::string(first, size) : fmt::format("{} bytes", size);
  }

  /// The element type of an array with any number of dimensions.
  static const IdlType& innermost(const IdlType& array) {
    const IdlType* type = &array;
    while (type->kind == Kind::kArray) type = type->element.get();
    return *type;
  }

  Json array(const IdlType& type) {
    if (type.element->kind != Kind::kArray) return elements(*type.element, type.bound);
    Json result = Json::array();
    for (std::uint32_t i = 0; i < type.bound; ++i) {
      count_elements(1);
      result.push_back(array(*type.element));
    }
    return result;
  }

  void count_elements(std::uint32_t count) {
    elements_ += count;
    if (elements_ > kMaxElements) throw IdlDecodingError("the message has too many elements");
  }

  Json elements(const IdlType& type, std::uint32_t size) {
    count_elements(size);
    Json result = Json::array();
    for (std::uint32_t i = 0; i < size; ++i) result.push_back(decode(type));
    return result;
  }

  Json members(const IdlType& type) {
    if (type.extensibility == IdlType::Extensibility::kMutable)
      throw IdlDecodingError(type.name + " is mutable, which is not supported");
    if (is_delimited_ && type.extensibility == IdlType::Extensibility::kAppendable) number<std::uint32_t>();
    Json result = Json::object();
    for (const IdlMember& member : type.members) {
      if (member.is_optional)
        throw IdlDecodingError(
            fmt::format("{}.{} is optional, which is not supported", type.name, member.name));
      result[member.name] = decode(*member.type);
    }
    return result;
  }

  OctetSequences octets_;
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0, elements_ = 0;
  bool is_swapped_ = false, is_version_2_ = false, is_delimited_ = false;
};

}  // namespace

Json decode_by_idl(const IdlType& type, std::span<const std::uint8_t> bytes, OctetSequences octets) {
  return Decoder(bytes, octets).decode(type);
}

}  // namespace sidestep
