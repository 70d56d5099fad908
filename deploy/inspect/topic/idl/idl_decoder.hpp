// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

#include "deploy/inspect/topic/idl/idl_type.hpp"

namespace sidestep {

/// Thrown if bytes are not a valid message of the expected type.
class IdlDecodingError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How sequences of octets are decoded: to lists of numbers, or to text. With kText, sequences without a
/// bound or with one above 64 KiB, such as images, are replaced by their size: "2500000 bytes".
enum class OctetSequences : std::uint8_t { kNumbers, kText };

/// Decodes untrusted bytes of a message, with its encapsulation header (DDS-XTypes 1.3, 7.4: plain CDR of
/// versions 1 and 2, and delimited CDR 2, in either byte order), to JSON with enumerators by name. Throws
/// IdlDecodingError, including for mutable types and optional members, which are not supported.
[[nodiscard]] nlohmann::ordered_json decode_by_idl(const IdlType& type, std::span<const std::uint8_t> bytes,
                                                   OctetSequences octets = OctetSequences::kNumbers);

}  // namespace sidestep
