// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace sidestep {

/// All definitions in idl/, without comments and includes. Some occur several times.
extern const char* const kIdlText;

/// The IDL of a message type and of all definitions that it uses; each definition follows those that it uses.
/// `idl` contains definitions in modules, without comments and preprocessor directives. Throws
/// std::invalid_argument if it does not define the type, for example sidestep::msg::Verdict.
[[nodiscard]] std::string message_schema(std::string_view type, std::string_view idl = kIdlText);

}  // namespace sidestep
