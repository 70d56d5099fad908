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

/// Decodes untrusted bytes of a message, with its encapsulation header (DDS-XTypes 1.3, 7.4: plain CDR of
/// versions 1 and 2, and delimited CDR 2, in either byte order), to JSON, with enumerators by name, and
/// octets of sequences and arrays as numbers. Throws IdlDecodingError, including for mutable types and
/// optional members, which are not supported.
[[nodiscard]] nlohmann::ordered_json decode_by_idl(const IdlType& type, std::span<const std::uint8_t> bytes);

}  // namespace sidestep
