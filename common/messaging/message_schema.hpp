// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace sidestep {

/// All definitions of idl/, without comments and includes. Some occur several times.
extern const char* const kIdlText;

/// The IDL of a message type and of everything that it uses, in an order in which each definition comes after
/// those that it uses. `idl`: definitions in modules, without comments and preprocessor directives. Throws
/// std::invalid_argument if the type, e.g. sidestep::msg::Verdict, is not among them.
[[nodiscard]] std::string message_schema(std::string_view type, std::string_view idl = kIdlText);

}  // namespace sidestep
