// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "deploy/monitor/topic/idl/idl_type.hpp"

namespace sidestep {

/// What is wrong with IDL, and where: "order.idl:7: expected ';', got 'long'".
class IdlError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Enums and structs by their full names.
using IdlTypes = std::map<std::string, IdlTypePtr>;

/// Parses OMG IDL: modules, structs with inheritance, enums, typedefs, constants, sequences, strings, arrays,
/// and the annotations @key, @optional, @final, @appendable, @mutable, @value and @extensibility; others are
/// passed over, and so are directives other than #include "FILE". Throws IdlError, also for what is valid but
/// not supported: unions, bitmasks, maps, fixed and wide types, macros.
[[nodiscard]] IdlTypes parse_idl(std::string_view text, const std::string& file_name);
/// The same of a file and those that it includes, relative to itself.
[[nodiscard]] IdlTypes load_idl(const std::string& path);

}  // namespace sidestep
