// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "common/messaging/cdr.hpp"
#include "deploy/inspect/topic/idl/idl_type.hpp"

namespace sidestep {

/// Thrown if JSON is not a valid message of the expected type; the text names the member.
class IdlEncodingError : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Encodes JSON in the form that decode_by_idl() returns, as plain little-endian CDR of version 1 with its
/// encapsulation header. Omitted members are 0, false, empty or the first enumerator. Throws IdlEncodingError
/// for unknown members and values that do not fit.
[[nodiscard]] std::vector<std::uint8_t> encode_by_idl(const IdlType& type,
                                                      const nlohmann::ordered_json& json);

/// Whether the type has key members.
[[nodiscard]] bool is_keyed(const IdlType& type);

/// The key of a message as DDS sends it (RTPS 2.3, 9.6.3.8). Throws IdlEncodingError if the key members need
/// more than 16 bytes.
[[nodiscard]] CdrKey key_by_idl(const IdlType& type, const nlohmann::ordered_json& json);

}  // namespace sidestep
