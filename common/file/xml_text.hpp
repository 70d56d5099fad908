// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace sidestep {

/// The text for the content and the attributes of XML and HTML. Line ends and tabs are kept in attributes,
/// too. Characters that XML does not allow become U+FFFD, and so does each byte that is not UTF-8.
[[nodiscard]] std::string xml_escaped(std::string_view text);

}  // namespace sidestep
