// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sidestep {

struct IdlToken {
  std::string text;  ///< empty: end of the file. A scoped name, such as a::b, is one token; so is "::"
  int line = 0;
  bool is_string = false;
};

/// The tokens of IDL without comments, and the files that it includes. Throws IdlError.
struct IdlTokens {
  std::vector<IdlToken> tokens;
  std::vector<std::string> includes;
};
[[nodiscard]] IdlTokens tokens_of_idl(std::string_view text, const std::string& file_name);

}  // namespace sidestep
