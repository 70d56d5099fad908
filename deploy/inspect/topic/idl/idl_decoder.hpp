// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

#include "deploy/inspect/topic/idl/idl_type.hpp"

namespace sidestep {

/// Thrown if bytes are not a message of a type.
class IdlDecodingError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What sequences of octets become: lists of numbers, or text. Instead of text, those whose bound exceeds
/// 64 KiB, which are images, become their size: "2500000 bytes".
enum class OctetSequences : std::uint8_t { kNumbers, kText };

/// Decodes untrusted bytes of a message, with its encapsulation header (DDS-XTypes 1.3, 7.4: plain CDR of
/// versions 1 and 2, and delimited CDR 2, in either byte order), to JSON, with enumerators by name, and
/// octets as numbers, unless `octets` says otherwise. Throws IdlDecodingError, including for mutable types
/// and optional members, which are not supported.
[[nodiscard]] nlohmann::ordered_json decode_by_idl(const IdlType& type, std::span<const std::uint8_t> bytes,
                                                   OctetSequences octets = OctetSequences::kNumbers);

}  // namespace sidestep
