// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sidestep {

struct IdlType;
using IdlTypePtr = std::shared_ptr<const IdlType>;

struct IdlMember {
  std::string name;
  IdlTypePtr type;
  bool is_key = false;
  bool is_optional = false;
};

/// A type of OMG IDL 4.2, restricted to the constructs that DDS messages use.
struct IdlType {
  enum class Kind : std::uint8_t {
    kBoolean,
    kOctet,  ///< also uint8
    kChar,
    kInt8,
    kInt16,
    kInt32,
    kInt64,
    kUint16,
    kUint32,
    kUint64,
    kFloat,
    kDouble,
    kString,
    kSequence,
    kArray,
    kEnum,
    kStruct,
  };
  enum class Extensibility : std::uint8_t { kFinal, kAppendable, kMutable };

  Kind kind = Kind::kBoolean;
  std::string name{};                ///< name of an enum or a struct, for example sidestep::msg::Order
  std::uint32_t bound = 0;           ///< bound of a string or a sequence (0: unbounded), or size of an array
  IdlTypePtr element{};              ///< element type of a sequence or an array
  std::vector<IdlMember> members{};  ///< members of a struct, inherited ones first
  std::map<std::uint32_t, std::string> enumerators{};        ///< enumerators of an enum
  Extensibility extensibility = Extensibility::kAppendable;  ///< extensibility of a struct
  int depth = 1;                                             ///< nesting depth of types, including this one
  std::uint64_t values = 1;  ///< number of values in a message of this type whose sequences are empty
};

}  // namespace sidestep
