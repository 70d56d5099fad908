// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "common/messaging/cdr.hpp"
#include "deploy/monitor/topic/idl/idl_type.hpp"

namespace sidestep {

/// Why JSON is no message of a type; the text names the member.
class IdlEncodingError : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Encodes JSON as decode_by_idl() returns it, as plain CDR of version 1, little-endian, with its
/// encapsulation header. Members that are left out are 0, false, empty or the first enumerator. Throws
/// IdlEncodingError for unknown members and values that do not fit.
[[nodiscard]] std::vector<std::uint8_t> encode_by_idl(const IdlType& type,
                                                      const nlohmann::ordered_json& json);

/// Whether the type has key members.
[[nodiscard]] bool is_keyed(const IdlType& type);

/// The key of a message as DDS sends it (RTPS 2.3, 9.6.3.8). Throws
/// IdlEncodingError if they need more than 16 bytes.
[[nodiscard]] CdrKey key_by_idl(const IdlType& type, const nlohmann::ordered_json& json);

}  // namespace sidestep
