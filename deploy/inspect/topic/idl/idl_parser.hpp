// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "deploy/inspect/topic/idl/idl_type.hpp"

namespace sidestep {

/// An error in IDL text, with its location: "order.idl:7: expected ';', got 'long'".
class IdlError : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Enums and structs, indexed by their full names.
using IdlTypes = std::map<std::string, IdlTypePtr>;

/// Parses OMG IDL: modules, structs with inheritance, enums, typedefs, constants, sequences, strings, arrays,
/// and the annotations @key, @optional, @final, @appendable, @mutable, @value and @extensibility; other
/// annotations are ignored, and so are directives other than #include "FILE". Throws IdlError, including for
/// valid but unsupported constructs: unions, bitmasks, maps, fixed and wide types, macros.
[[nodiscard]] IdlTypes parse_idl(std::string_view text, const std::string& file_name);
/// Parses a file and the files that it includes, whose paths are relative to its folder.
[[nodiscard]] IdlTypes load_idl(const std::string& path);

}  // namespace sidestep
